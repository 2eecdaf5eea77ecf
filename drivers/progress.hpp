// How far a run has come: one line rewritten on a terminal, a plain line now and then elsewhere.
#pragma once

#include "drivers/run_setup.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft {

class Progress final : public RunListener {
 public:
  Progress(const RunSetup& run, bool quiet);
  void on_step(const RunState& state) override;
  void finish();  // ends the line

 private:
  double estimated_seconds_left(const RunState& state);

  const RunSetup& run_;
  bool quiet_, terminal_;
  Stopwatch watch_, since_line_;
  bool printed_ = false;
  long first_step_ = -1;
};

// 3725 -> "1:02:05"
std::string clock_text(double seconds);

}  // namespace traceraft
