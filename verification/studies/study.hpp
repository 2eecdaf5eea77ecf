// A verification study: something is measured and held against what is claimed of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "verification/bench/figures.hpp"

namespace traceraft::bench {
class Bench;
}

namespace traceraft::studies {

// One measured claim: `measured` must lie in [low, high].
struct Claim {
  std::string what;
  double measured;
  std::optional<double> expected;  // the value of theory, where there is one
  double low, high;
  double uncertainty = 0;  // of `measured`: half a 95 % interval; 0: not estimated

  bool holds() const { return measured >= low && measured <= high; }  // false for NaN
};

Claim claim_near(std::string what, double measured, double expected, double tolerance,
                 double uncertainty = 0);
// The observed order (statistics/power_law.hpp) of errors e ~ h^p, its uncertainty the change from
// coarser levels.
Claim claim_order(std::string what, const statistics::Points& size_and_error, double expected,
                  double tolerance);
Claim claim_at_most(std::string what, double measured, double bound);
Claim claim_at_least(std::string what, double measured, double bound, double uncertainty = 0);
Claim claim_between(std::string what, double measured, double low, double high);

struct StudyReport {
  std::vector<bench::Table> tables;
  std::vector<Claim> claims;
  std::vector<bench::Chart> charts;
  std::vector<std::string> notes;  // what a reader has to know, a sentence each
  std::string skipped = {};        // why this build cannot measure it
};

// Contract: `run` measures on the bench it is given and on nothing else. It throws InputError if
// the bench's integrator or solver cannot serve it and std::runtime_error if a computation fails,
// which is a claim that does not hold.
struct StudyEntry {
  std::string name;
  std::string summary;
  std::function<StudyReport(const bench::Bench&)> run;
  // Not part of "all", nor of the tests: takes very long, or makes claims about speed.
  bool by_name_only = false;
  // Never beside another study: starts ranks, which wait for each other by spinning.
  bool starts_ranks = false;
};

}  // namespace traceraft::studies
