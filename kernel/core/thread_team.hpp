// A fixed team of threads that run the same function on different blocks of work.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace traceraft {

// The result of a computation never depends on the size of the team: callers split their rows into
// blocks and each row is computed by one thread in one order.
class ThreadTeam {
 public:
  explicit ThreadTeam(int size);  // size >= 1; the calling thread is one of them
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  // Runs task(0) … task(size() − 1) and returns when all are done. The first exception
  // thrown by a task is thrown again here.
  // Calls from inside a task run serially.
  void run(const std::function<void(int)>& task) const;

  // Splits [0, count) into size() contiguous ranges and runs body(begin, end) on each.
  template <class Body>
  void for_range(std::size_t count, const Body& body) const {
    const auto parts = static_cast<std::size_t>(size());
    run([&](int part) {
      const auto p = static_cast<std::size_t>(part);
      body(count * p / parts, count * (p + 1) / parts);
    });
  }

  // Sums over [0, count): add(i, total) adds the part of i to a total. Totals are of chunks of
  // fixed size, so that the sum does not depend on the size of the team.
  template <class Add>
  double sum(std::size_t count, const Add& add) const {
    constexpr std::size_t kChunk = 1024;
    std::vector<double> partial((count + kChunk - 1) / kChunk, 0.0);
    for_range(partial.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk)
        for (std::size_t i = chunk * kChunk; i < std::min((chunk + 1) * kChunk, count); ++i)
          add(i, partial[chunk]);
    });
    double total = 0;
    for (const double part : partial) total += part;
    return total;
  }

 private:
  void work(int part);
  void stop_all();
  void guarded(const std::function<void(int)>& task, int part) const noexcept;

  // Code that changes `round_`, `stop_` or `pending_` to 0 holds the mutex, so that nobody who
  // falls asleep misses it.
  mutable std::mutex mutex_;
  mutable std::condition_variable start_, done_;
  mutable const std::function<void(int)>* task_ = nullptr;
  mutable std::atomic<unsigned long> round_{0};
  mutable std::atomic<int> pending_{0};
  mutable std::exception_ptr thrown_;
  std::atomic<bool> stop_{false};
  std::vector<std::thread> workers_;
};

}  // namespace traceraft
