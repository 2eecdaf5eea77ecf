#include "kernel/core/thread_team.hpp"

#include <utility>

namespace traceraft {
namespace {
thread_local bool inside_task = false;
}

ThreadTeam::ThreadTeam(int size) {
  try {
    for (int part = 1; part < size; ++part) workers_.emplace_back([this, part] { work(part); });
  } catch (...) {
    stop_all();
    throw;
  }
}

ThreadTeam::~ThreadTeam() {
  stop_all();
}

void ThreadTeam::stop_all() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  start_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadTeam::run(const std::function<void(int)>& task) const {
  if (workers_.empty() || inside_task) {
    for (int part = 0; part < size(); ++part) task(part);
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = &task;
    pending_ = static_cast<int>(workers_.size());
    ++round_;
  }
  start_.notify_all();
  inside_task = true;
  guarded(task, 0);
  inside_task = false;
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, [this] { return pending_ == 0; });
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void ThreadTeam::guarded(const std::function<void(int)>& task, int part) const noexcept {
  try {
    task(part);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!thrown_) thrown_ = std::current_exception();
  }
}

void ThreadTeam::work(int part) {
  inside_task = true;
  unsigned long seen = 0;
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    start_.wait(lock, [&] { return stop_ || round_ != seen; });
    if (stop_) return;
    seen = round_;
    const std::function<void(int)>& task = *task_;
    lock.unlock();
    guarded(task, part);
    lock.lock();
    if (--pending_ == 0) done_.notify_one();
  }
}

}  // namespace traceraft
