#include "backends/sundials/newton_test.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft::sundials {
namespace {

constexpr double kDivergence = 0.9;  // corrections that shrink less do not converge
constexpr double kCaution = 2;       // what is expected to be left counts so many times
constexpr int kMostSteps = 8;        // that rely on one measurement

}  // namespace

bool NewtonTest::trusted_for(double norm, double bound) const {
  if (experience_.steps >= kMostSteps) return false;
  const double growth = std::max(1.0, norm / experience_.norm);
  return kCaution * experience_.rate * growth * norm <= bound;
}

NewtonTest::Verdict NewtonTest::judge(int iteration, double norm, double bound) {
  if (!std::isfinite(norm)) return Verdict::diverges;
  if (iteration == 0) {
    first_ = norm;
    // If the correction itself is below the bound, far less than the bound is left.
    if (norm <= bound) return Verdict::converged;
    if (!trusted_for(norm, bound)) return Verdict::go_on;
    ++experience_.steps;
    return Verdict::converged;
  }
  const double rate = std::pow(norm / first_, 1.0 / iteration);
  if (iteration == 1) experience_ = {rate, first_, 0};
  if (rate > kDivergence) return Verdict::diverges;
  return rate / (1 - rate) * norm <= bound ? Verdict::converged : Verdict::go_on;
}

void NewtonTest::save(CheckpointOut out) const {
  write_binary(out, experience_);
}

void NewtonTest::load(CheckpointIn in) {
  read_binary(in, experience_);
}

}  // namespace traceraft::sundials
