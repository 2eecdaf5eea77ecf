#include "drivers/config/number_checks.hpp"

#include <cmath>
#include <functional>
#include <string>

#include "kernel/core/text.hpp"

namespace traceraft::config {
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

// `range`: for the help; `complaint`: after the number, where `holds` is false. A long double holds
// every whole number of 64 bits.
CLI::Validator checked(const std::string& range, const std::string& complaint,
                       const std::function<bool(long double)>& holds) {
  return {[=](std::string& text) {
            long double value = 0;
            CLI::detail::lexical_cast(text, value);
            return holds(value) ? std::string() : text + " is " + complaint;
          },
          range};
}

}  // namespace

CLI::Validator between(double low, double high) {
  const std::string from = as_number(low), to = as_number(high);
  return checked("in [" + from + " - " + to + "]", "not between " + from + " and " + to,
                 [=](long double value) { return value >= low && value <= high; });
}

CLI::Validator at_least(double low) {
  return checked(">= " + as_number(low), "less than " + as_number(low),
                 [=](long double value) { return value >= low; });
}

CLI::Validator positive() {
  return checked("> 0", "not positive", [](long double value) { return value > 0; });
}

void check_numbers_first(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    // Ranges follow after a colon. INTEGRATOR, the name of a list, begins as INT does.
    const std::string type = option->get_type_name(), number = type.substr(0, type.find(':'));
    const bool whole = number == "INT" || number == "UINT";
    if (!whole && number != "FLOAT") continue;
    option->transform(CLI::Validator(whole ? whole_number : finite_number, ""));
  }
}

}  // namespace traceraft::config
