// CRC-32 of stored data.
#pragma once

#include <cstdint>
#include <string_view>

namespace traceraft {

std::uint32_t crc32_of(std::string_view data);

}  // namespace traceraft
