#include "kernel/core/thread_team.hpp"

#include <chrono>
#include <utility>

namespace traceraft {
namespace {

thread_local bool inside_task = false;

// To sleep and to be woken takes as long, so that who waits looks for that time first: the tasks of
// a time step follow each other faster. Others may have the processor meanwhile.
constexpr std::chrono::microseconds kLook{100};

template <class Condition>
void look_for(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kLook;
  while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

}  // namespace

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
  const auto done = [this] { return pending_ == 0; };
  look_for(done);
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, done);
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
  const auto called = [&] { return stop_ || round_ != seen; };
  while (true) {
    look_for(called);
    std::unique_lock<std::mutex> lock(mutex_);
    start_.wait(lock, called);
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
