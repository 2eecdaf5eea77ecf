// What decides numbers as much as input does: the program itself.
#pragma once

#include <string>

namespace traceraft {

// Of the running program's file, in eight digits. Throws IoError.
std::string program_checksum();

}  // namespace traceraft
