#include "backends/zlib/checksum.hpp"

#include <zlib.h>

namespace traceraft::zlib {

std::uint32_t crc32_of(std::string_view data, std::uint32_t before) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(data.data()), data.size()));
}

}  // namespace traceraft::zlib
