#include "backends/nlopt/minimise.hpp"

#include <nlopt.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

namespace traceraft::nlopt {
namespace {

struct Call {
  const MinimiseRequest& request;
  nlopt_opt optimiser;
  std::vector<double> best;
  double best_value;
  int evaluations = 0;
  std::exception_ptr error;
};

// Exceptions must not pass through C.
double evaluate(unsigned size, const double* x, double*, void* data) {
  Call& call = *static_cast<Call*>(data);
  try {
    const std::vector<double> at(x, x + size);
    const double value = call.request.function(at);
    if (call.evaluations++ == 0 || value < call.best_value) {
      call.best = at;
      call.best_value = value;
    }
    return value;
  } catch (...) {
    call.error = std::current_exception();
    nlopt_force_stop(call.optimiser);
    return 0;
  }
}

}  // namespace

Minimum minimise(const MinimiseRequest& request) {
  const auto size = static_cast<unsigned>(request.start.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> optimiser(
      nlopt_create(NLOPT_LN_SBPLX, size), nlopt_destroy);
  if (!optimiser) throw std::runtime_error("NLopt: out of memory");
  Call call{request, optimiser.get(), request.start, 0, 0, nullptr};
  std::vector<double> precision, x = request.start;
  for (std::size_t i = 0; i < size; ++i)
    precision.push_back(request.tolerance * (request.upper[i] - request.lower[i]));
  nlopt_set_min_objective(optimiser.get(), evaluate, &call);
  nlopt_set_lower_bounds(optimiser.get(), request.lower.data());
  nlopt_set_upper_bounds(optimiser.get(), request.upper.data());
  nlopt_set_initial_step(optimiser.get(), request.step.data());
  nlopt_set_xtol_abs(optimiser.get(), precision.data());
  nlopt_set_maxeval(optimiser.get(), request.most_evaluations);
  double value = 0;
  const nlopt_result result = nlopt_optimize(optimiser.get(), x.data(), &value);
  if (call.error) std::rethrow_exception(call.error);
  if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED)
    throw std::runtime_error("NLopt failed with code " + std::to_string(result));
  return {call.best, call.best_value, call.evaluations,
          result != NLOPT_MAXEVAL_REACHED && result != NLOPT_ROUNDOFF_LIMITED};
}

}  // namespace traceraft::nlopt
