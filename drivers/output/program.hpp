// The program itself: it decides numbers as much as input does.
#pragma once

#include <string>

namespace traceraft::output {

// The checksum of the running program's file, in eight digits. Throws IoError.
std::string program_checksum();

// "traceraft 0.2.0, build 1a2b3c4d", the latter being that.
std::string program_text();

}  // namespace traceraft::output
