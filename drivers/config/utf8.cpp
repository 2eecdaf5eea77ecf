#include "drivers/config/utf8.hpp"

#include <nlohmann/json.hpp>

namespace traceraft {

bool is_utf8(const std::string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

}  // namespace traceraft
