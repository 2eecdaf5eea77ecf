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

// One that has what a whole search needs, with nothing hidden.
inline selection::BlindRequest searched_vesicle() {
  selection::BlindRequest asked;
  asked.base = bench::bench_model("degenerate", 0.15);
  asked.cells = 24;
  asked.first = 30;
  asked.last = 140;
  asked.snapshots = 5;
  asked.points = 1200;
  asked.seed = 2;
  return asked;
}

}  // namespace traceraft::testing
