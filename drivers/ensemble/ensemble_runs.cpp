#include "drivers/ensemble/ensemble_runs.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <thread>

#include "backends/posix/process.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/job_pool.hpp"
#include "drivers/run/program_run.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// What runs write about t and after it; progress is counted in ln t, over which work is spread.
constexpr double kFirstShare = 1e-6;

double share_done(double reached, double t_end) {
  if (!(reached > kFirstShare * t_end)) return 0;
  return std::min(1.0, 1 - std::log(reached / t_end) / std::log(kFirstShare));
}

ProgramEnd run_or_resume(const EnsembleFolder& folder, std::uint64_t seed, int threads) {
  const std::string run = folder.run_of(seed).string(), thread_text = std::to_string(threads);
  std::vector<std::string> arguments = {"resume", run, "--threads", thread_text, "--quiet"};
  if (folder.member(seed).end == MemberEnd::missing)
    arguments = {"run",    "--config",           folder.config().string(),
                 "--seed", std::to_string(seed), "--out",
                 run,      "--threads",          thread_text,
                 "--quiet"};
  return run_program(arguments, folder.log_of(seed));
}

// What is known of the members' ends.
class Ledger {
 public:
  explicit Ledger(fs::path folder) : folder_(std::move(folder)) {}
  // To be gone on with?
  bool settle(std::uint64_t seed, const ProgramEnd& end) {
    const std::lock_guard lock(mutex_);
    if (end.exit_code == kSuccess) return true;
    if (end.was_stopped()) return false;
    if (!end.is_its_own(folder_) && end.exit_code != kLocked)
      throw IoError("the run of seed " + std::to_string(seed) + ": " + end.reason());
    add_failure({seed, end.reason(), end.exit_code == kLocked});
    return true;
  }
  void add_failure(MemberFailure failure) { failures_.push_back(std::move(failure)); }
  std::vector<MemberFailure> failures() {
    std::sort(failures_.begin(), failures_.end(),
              [](const MemberFailure& a, const MemberFailure& b) { return a.seed < b.seed; });
    return failures_;
  }

 private:
  std::mutex mutex_;
  fs::path folder_;
  std::vector<MemberFailure> failures_;
};

void show_progress(const EnsemblePlan& plan, const EnsembleFolder& folder, double t_end,
                   double share_before, const Stopwatch& watch, StatusLine& line) {
  double share = 0;
  int finished = 0;
  for (const std::uint64_t seed : plan.seeds()) {
    const double own = share_done(folder.reached(seed), t_end);
    share += own / plan.runs;
    finished += own >= 1;
  }
  const double worked = share - share_before;
  const double left = worked > 0.01 ? watch.seconds() / worked * (1 - share) : 0;
  line.show(share, std::to_string(finished) + "/" + std::to_string(plan.runs) + " runs  " +
                       clock_text(watch.seconds()) + " elapsed" +
                       (left > 0 ? "  ~" + clock_text(left) + " left" : ""));
}

}  // namespace

Jobs jobs_of(int at_a_time, int threads) {
  const int processors = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (at_a_time == 0) at_a_time = processors;
  return {at_a_time, threads > 0 ? threads : std::max(1, processors / at_a_time)};
}

EnsembleEnd work_off(const EnsemblePlan& plan, const EnsembleFolder& folder, const Jobs& jobs,
                     double t_end, bool quiet) {
  std::vector<std::uint64_t> seeds;
  Ledger ledger(folder.path());
  double share_before = 0;
  for (const std::uint64_t seed : plan.seeds()) {
    const EnsembleFolder::Member member = folder.member(seed);
    share_before += share_done(folder.reached(seed), t_end) / plan.runs;
    if (member.end == MemberEnd::failed)
      ledger.add_failure({seed, member.why});
    else if (member.end != MemberEnd::finished)
      seeds.push_back(seed);
  }
  StatusLine line(quiet);
  const Stopwatch watch;
  JobPool pool(seeds.size(), [&](std::size_t k) {
    return ledger.settle(seeds[k], run_or_resume(folder, seeds[k], jobs.threads));
  });
  pool.start(jobs.at_a_time);
  do {
    usleep(100000);
    if (line.due()) show_progress(plan, folder, t_end, share_before, watch, line);
  } while (pool.busy());
  const bool all = pool.finish();
  line.finish();
  return {!all, ledger.failures()};
}

int run_member(const EnsembleFolder& folder, std::uint64_t seed, int threads, bool quiet) {
  const auto report = [seed, quiet](const std::string& what) {
    if (quiet) return;
    say("seed %llu: %s\n", static_cast<unsigned long long>(seed), what);
    flush_output();  // the log of a job is read while it runs
  };
  const MemberEnd before = folder.member(seed).end;
  if (before == MemberEnd::finished) {
    report("finished before");
    return kSuccess;
  }
  report(std::string(before == MemberEnd::missing ? "begins" : "goes on") +
         ", threads: " + std::to_string(threads));
  const Stopwatch watch;
  const ProgramEnd end = run_or_resume(folder, seed, threads);
  if (end.exit_code == kSuccess) report("finished after " + clock_text(watch.seconds()));
  if (end.exit_code != kSuccess) say_error("seed " + std::to_string(seed) + ": " + end.reason());
  return end.exit_code;
}

}  // namespace traceraft
