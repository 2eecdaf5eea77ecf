#include "drivers/config/number_checks.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "kernel/core/text.hpp"

namespace traceraft {
namespace {

std::string as_number(double value) {
  return formatted("%.16g", value);
}

std::string finite_number(const std::string& text) {
  double value = 0;
  return CLI::detail::lexical_cast(text, value) && std::isfinite(value)
             ? ""
             : "'" + text + "' is not a finite number";
}

std::string whole_number(const std::string& text) {
  std::int64_t value = 0;
  if (CLI::detail::lexical_cast(text, value)) return "";
  const std::string not_finite = finite_number(text);
  return not_finite.empty() ? "'" + text + "' is not a whole number in digits" : not_finite;
}

}  // namespace

CLI::Validator between(double low, double high) {
  const std::string range = std::isfinite(high)
                                ? "in [" + as_number(low) + " - " + as_number(high) + "]"
                                : ">= " + as_number(low);
  return {[=](std::string& text) {
            double value = 0;
            CLI::detail::lexical_cast(text, value);
            if (value >= low && value <= high) return std::string();
            return text + (std::isfinite(high)
                               ? " is not between " + as_number(low) + " and " + as_number(high)
                               : " is less than " + as_number(low));
          },
          range};
}

CLI::Validator at_least(double low) {
  return between(low, std::numeric_limits<double>::infinity());
}

CLI::Validator positive() {
  return {[](std::string& text) {
            double value = 0;
            CLI::detail::lexical_cast(text, value);
            return value > 0 ? std::string() : text + " is not positive";
          },
          "> 0"};
}

void check_numbers_first(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    const bool whole = type.compare(0, 3, "INT") == 0 || type.compare(0, 4, "UINT") == 0;
    if (!whole && type.compare(0, 5, "FLOAT") != 0) continue;
    option->transform(CLI::Validator(
        [check = whole ? whole_number : finite_number](std::string& text) { return check(text); },
        ""));
  }
}

}  // namespace traceraft
