#include "drivers/ensemble/ensemble_runs.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "backends/posix/process.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/program_run.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

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

// The runs that are at it, side by side.
class Workers {
 public:
  Workers(const EnsembleFolder& folder, std::vector<std::uint64_t> seeds, int threads)
      : folder_(folder), seeds_(std::move(seeds)), threads_(threads) {}

  ~Workers() {  // if something else failed meanwhile
    stop_ = true;
    join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  void start(int jobs) {
    working_ = jobs;
    for (int i = 0; i < jobs; ++i) workers_.emplace_back([this] { work(); });
  }
  bool busy() const { return working_ > 0; }
  long done() const { return done_; }
  // Waits for the end of all.
  EnsembleEnd finish() {
    join();
    if (error_) std::rethrow_exception(error_);
    std::sort(end_.failures.begin(), end_.failures.end(),
              [](const MemberFailure& a, const MemberFailure& b) { return a.seed < b.seed; });
    return end_;
  }

 private:
  void join() {
    for (std::thread& worker : workers_)
      if (worker.joinable()) worker.join();
  }

  void work() {
    try {
      for (std::size_t k; !stop_ && !stop_requested() && (k = next_++) < seeds_.size(); ++done_)
        settle(seeds_[k], run_or_resume(folder_, seeds_[k], threads_));
      if (stop_requested()) stop_ = true;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    --working_;
  }

  void settle(std::uint64_t seed, const ProgramEnd& end) {
    const std::lock_guard lock(mutex_);
    if (end.exit_code == kSuccess) return;
    if (end.was_stopped())
      end_.stopped = stop_ = true;
    else if (end.telling() || end.exit_code == kLocked)
      end_.failures.push_back({seed, end.reason()});
    else  // a full disk stops all
      throw IoError("the run of seed " + std::to_string(seed) + ": " + end.reason());
  }

  const EnsembleFolder& folder_;
  const std::vector<std::uint64_t> seeds_;
  const int threads_;
  std::vector<std::thread> workers_;
  std::atomic<std::size_t> next_{0};
  std::atomic<long> done_{0};
  std::atomic<int> working_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  EnsembleEnd end_;
  std::exception_ptr error_;
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
  EnsembleEnd known;
  double share_before = 0;
  for (const std::uint64_t seed : plan.seeds()) {
    const EnsembleFolder::Member member = folder.member(seed);
    share_before += share_done(folder.reached(seed), t_end) / plan.runs;
    if (member.end == MemberEnd::failed)
      known.failures.push_back({seed, member.why});
    else if (member.end != MemberEnd::finished)
      seeds.push_back(seed);
  }
  StatusLine line(quiet);
  const Stopwatch watch;
  Workers workers(folder, seeds, jobs.threads);
  const long count = static_cast<long>(seeds.size());
  workers.start(static_cast<int>(std::min<long>(jobs.at_a_time, count)));
  do {
    usleep(100000);
    if (line.due()) show_progress(plan, folder, t_end, share_before, watch, line);
  } while (workers.busy());
  EnsembleEnd end = workers.finish();
  line.finish();
  end.stopped = end.stopped || workers.done() < count;
  end.failures.insert(end.failures.begin(), known.failures.begin(), known.failures.end());
  return end;
}

int run_member(const EnsembleFolder& folder, std::uint64_t seed, int threads) {
  if (folder.member(seed).end == MemberEnd::finished) return kSuccess;
  const ProgramEnd end = run_or_resume(folder, seed, threads);
  if (end.exit_code != kSuccess)
    std::fprintf(stderr, "traceraft: seed %llu: %s\n", static_cast<unsigned long long>(seed),
                 end.reason().c_str());
  return end.exit_code;
}

}  // namespace traceraft
