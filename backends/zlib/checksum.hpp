// CRC-32 of stored data.
#pragma once

#include <cstdint>
#include <string_view>

namespace traceraft::zlib {

// `before`: the checksum of what stands before `data`, 0 if nothing does.
std::uint32_t crc32_of(std::string_view data, std::uint32_t before = 0);

}  // namespace traceraft::zlib
