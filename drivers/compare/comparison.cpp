#include "drivers/compare/comparison.hpp"

#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "drivers/input/json_members.hpp"
#include "drivers/run/finished_run.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::compare {
namespace {

// The counts that the table takes from the summary of a run.
constexpr const char* kCounts[] = {"steps",         "rejected",
                                   "failures",      "residuals",
                                   "jacobians",     "newton_iterations",
                                   "linear_setups", "linear_iterations",
                                   "fallbacks",     "peak_memory_mb",
                                   "mass_drift",    "energy_rises",
                                   "ranks",         "threads"};

double relative_error(const problem::DaeProblem& problem, const Vec& c, VecView reference) {
  Vec difference = Vec::Zero(problem.size()), exact = difference;
  difference.head(c.size()) = c - reference;
  exact.head(c.size()) = reference;
  return problem.norm(difference) / problem.norm(exact);
}

}  // namespace

template <class Members>
void describe(Members& members, ComparePlan& plan) {
  members("integrators", plan.integrators,
          input::Distinct{input::OneOf{"integrator", backends::integrators().names()}});
  members("linear_solvers", plan.linear_solvers,
          input::Distinct{input::OneOf{"linear solver", backends::linear_solvers().names()}});
  members("tolerances", plan.tolerances,
          input::Distinct{input::WithinRange{kLeastTolerance, kLargestTolerance}});
  members("ranks", plan.ranks, input::Distinct{input::WithinRange{1, kMostRanks}});
  members("repeat", plan.repeat, input::WithinRange{1, kMostRepetitions});
  members("reference_tolerance", plan.reference_tolerance,
          input::WithinRange{0, kLargestTolerance});
  members("time_limit", plan.time_limit, input::WithinRange{0, input::kAnyNumber});
  members("target_error", plan.target_error, input::WithinRange{0, input::kAnyNumber});
  members("initial_state", plan.initial_state, input::WithinRange{0, 0xFFFFFFFF});
  members("program", plan.program, input::AnyText{});
}

template <class Members>
void describe(Members& members, ComparisonFolder::Record& record) {
  members("failure", record.failure, input::AnyText{});
  members("time_limit", record.time_limit, input::WithinRange{0, input::kAnyNumber});
}

void ComparisonFolder::save(const ComparePlan& plan) const {
  input::write_json(plan_file(), input::object_of(plan));
}

ComparePlan ComparisonFolder::load() const {
  const bool of_comparison = input::from_json(plan_file(), [](const input::Json& json) {
    return !json.is_object() || json.contains("integrators");  // else a plan of another command
  });
  if (!of_comparison)
    throw InputError(path_.string() + " holds the plan of another command, not a comparison");
  return input::read_object<ComparePlan>(plan_file());
}

std::filesystem::path ComparisonFolder::run_of(const CompareJob& job) const {
  return path_ / "runs" / job.name();
}
std::filesystem::path ComparisonFolder::log_of(const CompareJob& job) const {
  return path_ / "runs" / (job.name() + ".log");
}
std::filesystem::path ComparisonFolder::record_of(const CompareJob& job) const {
  return path_ / "runs" / (job.name() + ".json");
}

void ComparisonFolder::record(const CompareJob& job, const Record& record) const {
  input::write_json(record_of(job), input::object_of(record), -1);
}

std::optional<ComparisonFolder::Record> ComparisonFolder::recorded(const CompareJob& job) const {
  if (!std::filesystem::exists(record_of(job))) return std::nullopt;
  return input::read_object<Record>(record_of(job));
}

bool ComparisonFolder::done(const CompareJob& job, const ComparePlan& plan) const {
  const auto settled = [&](const Record& record) {
    const bool may_take_longer =
        record.time_limit > 0 && (plan.time_limit == 0 || plan.time_limit > record.time_limit);
    return !record.failure.empty() && !may_take_longer;
  };
  if (const auto own = recorded(job)) return own->failure.empty() || settled(*own);
  // A job that failed is not repeated for its time.
  CompareJob first = job;
  first.repetition = 1;
  const auto record = recorded(first);
  return record && settled(*record);
}

void ComparisonFolder::add(const CompareJob& job, const problem::DaeProblem& problem,
                           VecView reference, bench::WorkPoint& point) const {
  const auto record = recorded(job);
  if (!record) return;
  if (!record->failure.empty()) {
    // A later repetition that was in bad luck takes nothing away from the others.
    if (point.wall_s.empty()) point.failure = record->failure;
    return;
  }
  input::from_json(run_of(job) / "summary.json", [&](const input::Json& summary) {
    point.cpu_s.push_back(summary.at("cpu_s"));
    point.wall_s.push_back(summary.at("wall_s"));
    if (point.wall_s.size() == 1)
      for (const char* count : kCounts) point.counts[count] = summary.at(count);
    return 0;
  });
  point.failure.clear();
  if (point.wall_s.size() > 1) return;
  point.error = relative_error(
      problem, run::concentration_at_end(run_of(job), static_cast<int>(reference.size())),
      reference);
}

std::vector<bench::WorkPoint> ComparisonFolder::points(const ComparePlan& plan,
                                                       const problem::DaeProblem& problem,
                                                       VecView reference) const {
  std::vector<bench::WorkPoint> points;
  for (const CompareJob& job : jobs_of(plan)) {
    const auto same = [&](const bench::WorkPoint& p) {
      return p.integrator == job.integrator && p.linear_solver == job.linear_solver &&
             p.tolerance == job.tolerance && p.ranks == job.ranks;
    };
    auto point = std::find_if(points.begin(), points.end(), same);
    if (point == points.end()) {
      points.push_back({job.integrator,
                        job.linear_solver,
                        job.tolerance,
                        "not run yet",
                        0,
                        {},
                        {},
                        {},
                        job.ranks});
      point = points.end() - 1;
    }
    add(job, problem, reference, *point);
  }
  for (bench::WorkPoint& point : points)
    if (point.ok() && !std::isfinite(point.error))
      point.failure = "its error is not a number: the reference is zero";
  return points;
}

}  // namespace traceraft::compare
