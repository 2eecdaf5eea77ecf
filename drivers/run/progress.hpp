// How far a run has come.
#pragma once

#include "drivers/output/status_line.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft {

class Progress final : public RunListener {
 public:
  Progress(const RunSetup& run, bool quiet) : run_(run), line_(quiet) {}
  void on_step(const RunState& state) override;
  void finish() { line_.finish(); }

 private:
  double estimated_seconds_left(const RunState& state);

  const RunSetup& run_;
  StatusLine line_;
  Stopwatch watch_;
  long first_step_ = -1;
};

}  // namespace traceraft
