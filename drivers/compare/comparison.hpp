// The folder of a comparison: its plan, the runs behind it and what they gave.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/compare/compare_plan.hpp"
#include "kernel/problem/dae_problem.hpp"
#include "verification/bench/work_precision.hpp"

namespace traceraft::compare {

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

  // The outcome of a job. `failure`: "" for a result, or why there is none. `time_limit`: after how
  // many seconds it was stopped, if it was stopped for taking too long.
  struct Record {
    std::string failure;
    double time_limit = 0;
  };
  void record(const CompareJob& job, const Record& record) const;
  // Is nothing left to do? What failed once is not repeated, unless it may take longer now.
  bool done(const CompareJob& job, const ComparePlan& plan) const;

  // The points of the recorded jobs: one per combination, in the order of the plan. Errors are
  // against the concentration of the reference.
  std::vector<bench::WorkPoint> points(const ComparePlan& plan, const problem::DaeProblem& problem,
                                       VecView reference) const;

 private:
  std::filesystem::path plan_file() const { return path_ / "plan.json"; }
  std::filesystem::path record_of(const CompareJob& job) const;
  std::optional<Record> recorded(const CompareJob& job) const;
  void add(const CompareJob& job, const problem::DaeProblem& problem, VecView reference,
           bench::WorkPoint& point) const;

  std::filesystem::path path_;
};

}  // namespace traceraft::compare
