// Text as pages and JSON files need it.
#pragma once

#include <string>

namespace traceraft {

bool is_utf8(const std::string& text);

}  // namespace traceraft
