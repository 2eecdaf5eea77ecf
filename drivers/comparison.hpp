// The folder of a comparison: its plan, the runs behind it and what they gave.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drivers/configuration.hpp"
#include "kernel/problem/dae_problem.hpp"
#include "verification/work_precision.hpp"

namespace traceraft {

struct ComparePlan {
  std::vector<std::string> integrators, linear_solvers;
  std::vector<double> tolerances;
  int repeat = 3;
  double reference_tolerance = 0;
  double time_limit = 0;    // seconds per run; 0: none
  double target_error = 0;  // 0: the smallest that all methods reach
};

// Has a run reached its end in this folder? Throws IoError if its summary is damaged.
bool run_finished(const std::filesystem::path& run_folder);

// One combination of the plan, run once.
struct CompareJob {
  std::string integrator, linear_solver;
  double tolerance;
  int repetition;  // from 1
  std::string name() const;
};

// Repetition by repetition, so that a machine that changes its speed changes it for all.
std::vector<CompareJob> jobs_of(const ComparePlan& plan);

class ComparisonFolder {
 public:
  explicit ComparisonFolder(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path config() const { return path_ / "config.toml"; }
  bool started() const { return std::filesystem::exists(plan_file()); }

  void save(const ComparePlan& plan) const;
  ComparePlan load() const;  // throws IoError if it is damaged

  std::filesystem::path run_of(const CompareJob& job) const;
  std::filesystem::path log_of(const CompareJob& job) const;
  // Has the job been done, be it in vain?
  bool done(const CompareJob& job) const;
  void record(const CompareJob& job, const std::string& failure) const;

  // What the recorded jobs gave: a point per combination, in the order of the plan. Errors are
  // against the concentration of the reference.
  std::vector<WorkPoint> points(const ComparePlan& plan, const DaeProblem& problem,
                                ConstVec reference) const;

 private:
  std::filesystem::path plan_file() const { return path_ / "plan.json"; }
  std::filesystem::path record_of(const CompareJob& job) const;

  std::filesystem::path path_;
};

}  // namespace traceraft
