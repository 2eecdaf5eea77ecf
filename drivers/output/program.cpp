#include "drivers/output/program.hpp"

#include <cstdint>

#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/version.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::output {

std::string program_checksum() {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 32;
  static const std::string checksum =
      formatted("%08x", zlib::crc32_of(posix::read_file(posix::own_program(), kLargest)));
  return checksum;
}

std::string program_text() {
  return "traceraft " + std::string(kVersion) + ", build " + program_checksum();
}

}  // namespace traceraft::output
