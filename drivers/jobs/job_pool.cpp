#include "drivers/jobs/job_pool.hpp"

#include <algorithm>

#include "backends/posix/process.hpp"

namespace traceraft::jobs {

JobPool::JobPool(std::size_t count, std::function<bool(std::size_t)> job)
    : count_(count), job_(std::move(job)) {}

JobPool::~JobPool() {
  stop_ = true;
  join();
}

void JobPool::start(int at_a_time) {
  working_ = static_cast<int>(std::min<std::size_t>(count_, static_cast<std::size_t>(at_a_time)));
  for (int i = working_; i > 0; --i) workers_.emplace_back([this] { work(); });
}

bool JobPool::finish() {
  join();
  if (error_) std::rethrow_exception(error_);
  return done_ == count_;
}

void JobPool::work() {
  try {
    for (std::size_t k; !stop_ && !posix::stop_requested() && (k = next_++) < count_; ++ended_) {
      if (job_(k))
        ++done_;
      else
        stop_ = true;
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = std::current_exception();
    stop_ = true;
  }
  --working_;
}

void JobPool::join() {
  for (std::thread& worker : workers_)
    if (worker.joinable()) worker.join();
}

}  // namespace traceraft::jobs
