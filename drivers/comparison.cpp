#include "drivers/comparison.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "drivers/checkpoint_store.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft {
namespace {

constexpr std::uint64_t kMaxBytes = 1 << 24;
// What the table takes from the summary of a run.
constexpr const char* kCounts[] = {"steps",          "rejected",          "failures",
                                   "residuals",      "jacobians",         "newton_iterations",
                                   "linear_setups",  "linear_iterations", "fallbacks",
                                   "peak_memory_mb", "mass_drift",        "energy_rises"};

nlohmann::json parsed(const std::filesystem::path& path) {
  try {
    return nlohmann::json::parse(read_file(path, kMaxBytes));
  } catch (const nlohmann::json::exception& error) {
    throw IoError(path.string() + " is damaged: " + error.what());
  }
}

double relative_error(const DaeProblem& problem, const Vec& c, ConstVec reference) {
  Vec difference = Vec::Zero(problem.size()), exact = difference;
  difference.head(c.size()) = c - reference;
  exact.head(c.size()) = reference;
  return problem.norm(difference) / problem.norm(exact);
}

}  // namespace

bool run_finished(const std::filesystem::path& run_folder) {
  const std::filesystem::path summary = run_folder / "summary.json";
  return std::filesystem::exists(summary) && parsed(summary).value("end", "") == "finished";
}

std::string CompareJob::name() const {
  return integrator + "-" + linear_solver + "-" + format_number(tolerance) + "-" +
         std::to_string(repetition);
}

std::vector<CompareJob> jobs_of(const ComparePlan& plan) {
  std::vector<CompareJob> jobs;
  for (int repetition = 1; repetition <= plan.repeat; ++repetition)
    for (const std::string& integrator : plan.integrators)
      for (const std::string& solver : plan.linear_solvers)
        for (const double tolerance : plan.tolerances)
          jobs.push_back({integrator, solver, tolerance, repetition});
  return jobs;
}

void ComparisonFolder::save(const ComparePlan& plan) const {
  const nlohmann::ordered_json json = {{"integrators", plan.integrators},
                                       {"linear_solvers", plan.linear_solvers},
                                       {"tolerances", plan.tolerances},
                                       {"repeat", plan.repeat},
                                       {"reference_tolerance", plan.reference_tolerance},
                                       {"time_limit", plan.time_limit},
                                       {"target_error", plan.target_error}};
  write_durably(plan_file(), json.dump(2) + "\n");
}

ComparePlan ComparisonFolder::load() const {
  try {
    const nlohmann::json json = parsed(plan_file());
    return {json.at("integrators"), json.at("linear_solvers"),      json.at("tolerances"),
            json.at("repeat"),      json.at("reference_tolerance"), json.at("time_limit"),
            json.at("target_error")};
  } catch (const nlohmann::json::exception& error) {
    throw IoError(plan_file().string() + " is damaged: " + error.what());
  }
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

bool ComparisonFolder::done(const CompareJob& job) const {
  if (std::filesystem::exists(record_of(job))) return true;
  // What failed is not repeated for its time.
  CompareJob first = job;
  first.repetition = 1;
  return std::filesystem::exists(record_of(first)) &&
         !parsed(record_of(first)).value("failure", "").empty();
}

void ComparisonFolder::record(const CompareJob& job, const std::string& failure) const {
  write_durably(record_of(job), nlohmann::json{{"failure", failure}}.dump() + "\n");
}

std::vector<WorkPoint> ComparisonFolder::points(const ComparePlan& plan, const DaeProblem& problem,
                                                ConstVec reference) const {
  std::vector<WorkPoint> points;
  for (const CompareJob& job : jobs_of(plan)) {
    const auto same = [&](const WorkPoint& p) {
      return p.integrator == job.integrator && p.linear_solver == job.linear_solver &&
             p.tolerance == job.tolerance;
    };
    auto point = std::find_if(points.begin(), points.end(), same);
    if (point == points.end()) {
      points.push_back({job.integrator, job.linear_solver, job.tolerance, "", 0, {}, {}, {}});
      point = points.end() - 1;
    }
    if (!std::filesystem::exists(record_of(job))) continue;
    const std::string failure = parsed(record_of(job)).value("failure", "");
    if (!failure.empty()) {
      point->failure = failure;
      continue;
    }
    const nlohmann::json summary = parsed(run_of(job) / "summary.json");
    point->cpu_s.push_back(summary.at("cpu_s"));
    point->wall_s.push_back(summary.at("wall_s"));
    if (job.repetition > 1) continue;
    for (const char* count : kCounts) point->counts[count] = summary.at(count);
    const Vec c = newest_concentration(run_of(job), static_cast<int>(reference.size()));
    point->error = relative_error(problem, c, reference);
  }
  for (WorkPoint& point : points)
    if (point.ok() && point.wall_s.empty()) point.failure = "not run yet";
  return points;
}

}  // namespace traceraft
