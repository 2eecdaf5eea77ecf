#include "drivers/ensemble/ensemble_runs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drivers/config/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/disc_run.hpp"
#include "drivers/run/summary.hpp"
#include "drivers/text/say.hpp"

namespace traceraft::ensemble {
namespace {

// The share of t_end after which progress is counted: in ln t, over which work is spread.
constexpr double kFirstShare = 1e-6;

double share_done(double reached, double t_end) {
  if (!(reached > kFirstShare * t_end)) return 0;
  return std::min(1.0, 1 - std::log(reached / t_end) / std::log(kFirstShare));
}

// Discs take less time than a process does to start.
jobs::ProcessEnd run_here(const config::GivenValues& model, const EnsembleFolder& folder,
                          std::uint64_t seed) {
  try {
    config::GivenValues given = model;
    given["seed"] = {std::to_string(seed), "--seed"};
    const simulation::RunResult result =
        run::carry_out_disc_run(config::Configuration(given, {}), folder.run_of(seed));
    return {run::exit_code(result), false, result.why};
  } catch (...) {
    const drivers::Failure failure = drivers::failure_of(std::current_exception());
    return {failure.code, false, failure.why};
  }
}

// The model of the runs in this folder if it is one of discs.
std::optional<config::GivenValues> model_of_discs(const EnsembleFolder& folder) {
  config::GivenValues model = config::read_config_file(folder.config());
  if (!run::is_of_discs(config::Configuration(model, {}))) return std::nullopt;
  return model;
}

jobs::ProcessEnd run_or_resume(const EnsembleFolder& folder,
                               const std::optional<config::GivenValues>& discs, std::uint64_t seed,
                               int threads) {
  if (discs) return run_here(*discs, folder, seed);
  const std::string run = folder.run_of(seed).string(), thread_text = std::to_string(threads);
  std::vector<std::string> arguments = {"resume", run, "--threads", thread_text, "--quiet"};
  if (folder.member(seed).end == MemberEnd::missing)
    arguments = {"run",    "--config",           folder.config().string(),
                 "--seed", std::to_string(seed), "--out",
                 run,      "--threads",          thread_text,
                 "--quiet"};
  return jobs::run_program(arguments, folder.log_of(seed));
}

}  // namespace

EnsembleEnd run_members(const EnsemblePlan& plan, const EnsembleFolder& folder,
                        const jobs::Jobs& jobs, double t_end, bool quiet) {
  std::vector<std::uint64_t> seeds;
  EnsembleEnd result;
  for (const std::uint64_t seed : plan.seeds()) {
    const EnsembleFolder::Member member = folder.member(seed);
    if (member.end == MemberEnd::failed)
      result.failures.push_back({seed, member.why});
    else if (member.end != MemberEnd::finished)
      seeds.push_back(seed);
  }
  jobs::PendingJobs work;
  work.count = seeds.size();
  work.before = static_cast<std::size_t>(plan.runs) - seeds.size();
  work.at_a_time = jobs.at_a_time;
  work.kind = "runs";
  work.folder = folder.path();
  work.quiet = quiet;
  const std::optional<config::GivenValues> discs = model_of_discs(folder);
  work.run = [&](std::size_t k) { return run_or_resume(folder, discs, seeds[k], jobs.threads); };
  work.name = [&](std::size_t k) { return "the run of seed " + std::to_string(seeds[k]); };
  work.share = [&] {
    double share = 0;
    for (const std::uint64_t seed : plan.seeds())
      share += share_done(folder.reached(seed), t_end) / plan.runs;
    return share;
  };
  const jobs::JobsEnd end = jobs::run_pending_jobs(work);
  for (const jobs::JobFailure& failure : end.failures)
    result.failures.push_back({seeds[failure.job], failure.why, failure.locked});
  std::sort(result.failures.begin(), result.failures.end(),
            [](const MemberFailure& a, const MemberFailure& b) { return a.seed < b.seed; });
  result.stopped = end.stopped;
  return result;
}

int run_member(const EnsembleFolder& folder, std::uint64_t seed, int threads, bool quiet) {
  const auto report = [seed, quiet](const std::string& what) {
    if (quiet) return;
    text::say("seed %llu: %s\n", static_cast<unsigned long long>(seed), what);
    text::flush_output();  // the log of a job is read while it runs
  };
  const MemberEnd before = folder.member(seed).end;
  if (before == MemberEnd::finished) {
    report("already finished");
    return drivers::kSuccess;
  }
  report(std::string(before == MemberEnd::missing ? "starts" : "continues") +
         ", threads: " + std::to_string(threads));
  const Stopwatch watch;
  const jobs::ProcessEnd end = run_or_resume(folder, model_of_discs(folder), seed, threads);
  if (end.exit_code == drivers::kSuccess)
    report("finished after " + output::clock_text(watch.seconds()));
  if (end.exit_code != drivers::kSuccess)
    text::say_error("seed " + std::to_string(seed) + ": " + end.reason());
  return end.exit_code;
}

}  // namespace traceraft::ensemble
