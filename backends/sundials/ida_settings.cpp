#include "backends/sundials/ida_settings.hpp"

#include <algorithm>
#include <limits>

namespace traceraft::sundials {
namespace {

// These and the factor of Newton's test below were chosen by measuring cost and error:
// docs/decisions/0008-ida.md.
constexpr double kLinearTolerance = 5e-2;
constexpr double kLaterFactor = 10;

}  // namespace

std::vector<ParameterSpec> ida_parameters() {
  return {
      {"rtol", "", 0, 0, 0.5,
       "relative tolerance in the L2 norm on the surface; 0: that of all integrators"},
      {"atol", "", 0, 0, 1e3, "absolute tolerance of c; 0: 1e-10"},
      {"maxord", "", 5, 1, 5, "maximum order of the BDF", ParameterKind::integer},
      {"initstep", "s", 0, 0, 1e300, "first step; 0: that of all integrators"},
      {"maxstep", "s", 0, 0, 1e300, "largest step; 0: that of all integrators"},
      {"suppressalg", "", 1, 0, 1,
       "1: leave algebraic variables out of the error test; 0: include them",
       ParameterKind::integer},
      {"epslin", "", 0, 0, 0.5,
       "relative residual of Newton corrections; 0: that of all integrators"},
      {"nonlinconvcoef", "", 0.66, 1e-6, 1, "factor in the convergence test of Newton's method"},
  };
}

IdaSettings::IdaSettings(const time::IntegratorSettings& settings) : settings_(settings) {
  for (const ParameterSpec& spec : ida_parameters())
    settings_.method_options.emplace(spec.name, spec.default_value);
}

double IdaSettings::linear_tolerance(int correction) const {
  const double first = either("epslin", settings_.linear_tolerance_or(kLinearTolerance));
  return correction == 0 ? first : std::min(0.5, kLaterFactor * first);
}

double IdaSettings::max_step() const {
  const double asked = either("maxstep", settings_.max_step);
  return asked > 0 ? asked : std::numeric_limits<double>::infinity();
}

double IdaSettings::min_step(double span) const {
  return settings_.min_step > 0 ? settings_.min_step : 1e-14 * span;
}

}  // namespace traceraft::sundials
