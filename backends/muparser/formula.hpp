// Formulas typed by the user, parsed by muParser.
#pragma once

#include <functional>
#include <string>

#include "kernel/core/types.hpp"

namespace traceraft::muparser {

// A function of x, y, z (units of R) with pi, e and muParser's functions (sin, exp, sqrt, abs, min,
// ?: …). `context` names the option in errors. Throws InputError for a formula that cannot be
// parsed, with the position, and for one that assigns. The result may be called from several
// threads.
std::function<double(const Point&)> parse_formula(const std::string& context,
                                                  const std::string& formula);

}  // namespace traceraft::muparser
