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
  Progress(const RunSchedule& run, bool quiet) : run_(run), line_(quiet), left_(run.t_end) {}
  void on_step(const simulation::RunState& state) override;
  // Times in R²/D.
  void show(double t, std::int64_t steps, double step, double mass_drift, int rafts);
  void finish() { line_.finish(); }

 private:
  const RunSchedule& run_;
  output::StatusLine line_;
  output::TimeLeft left_;
  Stopwatch watch_;
};

}  // namespace traceraft::run
