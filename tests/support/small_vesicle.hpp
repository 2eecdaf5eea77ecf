// A blind case that takes seconds: a small vesicle, measured with little noise.
#pragma once

#include "verification/bench/bench.hpp"
#include "verification/selection/blind/blind_case.hpp"

namespace traceraft::testing {

inline selection::BlindRequest small_vesicle(int snapshots) {
  selection::BlindRequest asked;
  asked.base = bench::bench_model("degenerate", 0.2);
  asked.cells = 22;
  asked.first = 10;
  asked.last = 60;
  asked.snapshots = snapshots;
  asked.points = 1000;
  asked.gap = 0.2;
  asked.effects = {"uptake"};
  asked.noise = 0.05;
  asked.seed = 3;
  return asked;
}

}  // namespace traceraft::testing
