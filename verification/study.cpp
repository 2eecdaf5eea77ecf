#include "verification/study.hpp"

#include <limits>

namespace traceraft {

Claim claim_near(std::string what, double measured, double expected, double tolerance) {
  return {std::move(what), measured, expected, expected - tolerance, expected + tolerance};
}

Claim claim_at_most(std::string what, double measured, double bound) {
  return {std::move(what), measured, {}, -std::numeric_limits<double>::infinity(), bound};
}

Claim claim_between(std::string what, double measured, double low, double high) {
  return {std::move(what), measured, {}, low, high};
}

}  // namespace traceraft
