// When an approximate inverse made for one Jacobian has become dearer than a new one.
#pragma once

namespace traceraft {

// Iterations since the last set-up: the fewest a solve took, and those beyond that, summed. Counts
// decide, not clocks, so that runs repeat themselves.
struct Effort {
  long fewest = -1;
  long extra = 0;

  void count(int iterations) {
    if (fewest < 0 || iterations < fewest) fewest = iterations;
    extra += iterations - fewest;
  }
};

// `price`: what a set-up costs, in iterations.
inline bool is_worn(double setup_shift, double shift, long extra, long price) {
  const double change = shift / setup_shift;
  return !(change < 4 && change > 0.25) || extra >= price;
}

}  // namespace traceraft
