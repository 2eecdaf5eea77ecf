#include "verification/studies/study.hpp"

#include <limits>

namespace traceraft::studies {

Claim claim_near(std::string what, double measured, double expected, double tolerance,
                 double uncertainty) {
  return {std::move(what),      measured,   expected, expected - tolerance,
          expected + tolerance, uncertainty};
}

Claim claim_order(std::string what, const statistics::Points& size_and_error, double expected,
                  double tolerance) {
  const statistics::ObservedOrder found = statistics::observed_order(size_and_error);
  return claim_near(std::move(what), found.order, expected, tolerance, found.change);
}

Claim claim_at_most(std::string what, double measured, double bound) {
  return {std::move(what), measured, {}, -std::numeric_limits<double>::infinity(), bound};
}

Claim claim_at_least(std::string what, double measured, double bound, double uncertainty) {
  return {std::move(what), measured, {}, bound, std::numeric_limits<double>::infinity(),
          uncertainty};
}

Claim claim_between(std::string what, double measured, double low, double high) {
  return {std::move(what), measured, {}, low, high};
}

}  // namespace traceraft::studies
