// Plain binary reading and writing of numbers and vectors, for checkpoints of one program on one
// machine type.
#pragma once

#include <cstdint>
#include <istream>
#include <ostream>
#include <string>
#include <type_traits>

#include "kernel/core/error.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {

template <class T>
void write_binary(std::ostream& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

// Throws IoError at the end of the data.
template <class T>
void read_binary(std::istream& in, T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (!in.read(reinterpret_cast<char*>(&value), sizeof value))
    throw IoError("checkpoint: it ends too early");
}

inline void write_binary(std::ostream& out, const Vec& v) {
  write_binary(out, static_cast<std::int64_t>(v.size()));
  out.write(reinterpret_cast<const char*>(v.data()),
            static_cast<std::streamsize>(sizeof(double)) * v.size());
}

// `expected`: the length the reader needs; anything else is refused before memory is allocated.
inline void read_binary(std::istream& in, Vec& v, Eigen::Index expected) {
  std::int64_t size = 0;
  read_binary(in, size);
  if (size != expected)
    throw IoError("checkpoint: a vector has length " + std::to_string(size) + ", expected " +
                  std::to_string(expected));
  v.resize(expected);
  if (!in.read(reinterpret_cast<char*>(v.data()),
               static_cast<std::streamsize>(sizeof(double)) * expected))
    throw IoError("checkpoint: it ends too early");
}

}  // namespace traceraft
