#include "backends/zlib/vtk_array.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "kernel/core/error.hpp"

namespace traceraft::zlib {
namespace {

constexpr std::size_t kBlock = 1 << 16;                     // bytes compressed at a time
constexpr std::uint64_t kLargest = std::uint64_t{1} << 34;  // more is damage
constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string compressed(const Bytef* data, std::size_t size) {
  uLongf length = compressBound(size);
  std::string block(length, '\0');
  if (compress2(reinterpret_cast<Bytef*>(block.data()), &length, data, size, 6) != Z_OK)
    throw std::runtime_error("zlib could not compress a field");
  block.resize(length);
  return block;
}

[[noreturn]] void damaged() {
  throw IoError("a compressed array is damaged");
}

// The bytes of `count` base64 digits, padding included.
std::string from_base64(const char* digits, std::size_t count) {
  static const std::array<int, 256> values = [] {
    std::array<int, 256> table;
    table.fill(-1);
    for (int i = 0; i < 64; ++i) table[static_cast<unsigned char>(kDigits[i])] = i;
    table['='] = 0;
    return table;
  }();
  std::size_t padding = 0;
  while (padding < count && digits[count - 1 - padding] == '=') ++padding;
  if (count % 4 != 0 || padding > 2 ||
      std::find(digits, digits + count - padding, '=') != digits + count - padding)
    damaged();
  std::string data;
  data.reserve(count / 4 * 3);
  for (std::size_t i = 0; i < count; i += 4) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const int value = values[static_cast<unsigned char>(digits[i + k])];
      if (value < 0) damaged();
      bits = bits << 6 | static_cast<std::uint32_t>(value);
    }
    for (int k = 0; k < 3; ++k) data += static_cast<char>(bits >> (16 - 8 * k) & 255);
  }
  data.resize(data.size() - padding);
  return data;
}

std::size_t base64_size(std::size_t bytes) {
  return (bytes + 2) / 3 * 4;
}

}  // namespace

std::string base64(const std::string& data) {
  std::string text;
  text.reserve(base64_size(data.size()));
  for (std::size_t i = 0; i < data.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, data.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(data[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string encoded_array(const void* source, std::size_t bytes) {
  const auto* data = static_cast<const Bytef*>(source);
  std::string blocks;
  std::vector<std::uint64_t> header = {(bytes + kBlock - 1) / kBlock, kBlock, bytes % kBlock};
  for (std::size_t begin = 0; begin < bytes; begin += kBlock) {
    const std::string block = compressed(data + begin, std::min(kBlock, bytes - begin));
    blocks += block;
    header.push_back(block.size());
  }
  std::string head(reinterpret_cast<const char*>(header.data()),
                   header.size() * sizeof(std::uint64_t));
  return base64(head) + base64(blocks);
}

std::string decoded_array(const std::string& text) {
  // The number of blocks is in the first 8 bytes; it gives the length of the header.
  if (text.size() < 12) damaged();
  std::uint64_t count = 0;
  const std::string first = from_base64(text.data(), 12);
  if (first.size() < sizeof count) damaged();
  std::memcpy(&count, first.data(), sizeof count);
  if (count > kLargest / kBlock) damaged();
  const std::size_t head_bytes = (3 + count) * sizeof(std::uint64_t);
  const std::size_t head_digits = base64_size(head_bytes);
  if (text.size() < head_digits) damaged();
  std::vector<std::uint64_t> header(3 + count);
  const std::string head = from_base64(text.data(), head_digits);
  if (head.size() != head_bytes) damaged();
  std::memcpy(header.data(), head.data(), head_bytes);
  if (header[1] != kBlock) damaged();  // the only size that is written
  const std::string blocks = from_base64(text.data() + head_digits, text.size() - head_digits);
  std::string data;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t packed = header[3 + k];
    uLongf size = k + 1 == count && header[2] != 0 ? header[2] : header[1];
    if (size > header[1] || packed > blocks.size() - begin) damaged();
    std::string block(size, '\0');
    if (uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                   reinterpret_cast<const Bytef*>(blocks.data()) + begin, packed) != Z_OK ||
        size != block.size())
      damaged();
    data += block;
    begin += packed;
  }
  return data;
}

std::string deflated(const std::string& data) {
  return compressed(reinterpret_cast<const Bytef*>(data.data()), data.size());
}

}  // namespace traceraft::zlib
