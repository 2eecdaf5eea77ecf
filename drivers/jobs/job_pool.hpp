// Jobs done side by side by threads of this process, most of which wait for processes of their own.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace traceraft::jobs {

class JobPool {
 public:
  // job(0) … job(count − 1), begun in that order. A job that returns false, an exception of one,
  // and a request to stop this process (process.hpp) keep others from being begun.
  JobPool(std::size_t count, std::function<bool(std::size_t)> job);
  ~JobPool();  // waits for those that are at it
  JobPool(const JobPool&) = delete;
  JobPool& operator=(const JobPool&) = delete;

  void start(int at_a_time);
  bool busy() const { return working_ > 0; }
  std::size_t ended() const { return ended_; }
  // Waits for the end of all and throws what a job has thrown. Have all been done?
  bool finish();

 private:
  void work();
  void join();

  const std::size_t count_;
  const std::function<bool(std::size_t)> job_;
  std::vector<std::thread> workers_;
  std::atomic<std::size_t> next_{0}, ended_{0}, done_{0};
  std::atomic<int> working_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace traceraft::jobs
