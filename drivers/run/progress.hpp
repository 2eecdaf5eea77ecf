// How far a run has come.
#pragma once

#include "drivers/output/status_line.hpp"
#include "drivers/output/time_left.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/simulation/run_loop.hpp"

namespace traceraft::run {

class Progress final : public simulation::RunListener {
 public:
  Progress(const RunSetup& run, bool quiet) : run_(run), line_(quiet), left_(run.t_end) {}
  void on_step(const simulation::RunState& state) override;
  void finish() { line_.finish(); }

 private:
  const RunSetup& run_;
  output::StatusLine line_;
  output::TimeLeft left_;
  Stopwatch watch_;
};

}  // namespace traceraft::run
