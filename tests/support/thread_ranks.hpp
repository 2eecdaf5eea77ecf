// Several ranks in one process, each a thread: what is distributed can be tested without MPI.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "kernel/core/communicator.hpp"

namespace traceraft::testing {

// Messages between the threads; a rank that fails frees the others.
class ThreadRanks {
 public:
  explicit ThreadRanks(int size) : size_(size), sent_(static_cast<std::size_t>(size)) {}

  int size() const { return size_; }

  std::vector<std::string> exchange(int rank, std::vector<std::string> to) {
    if (static_cast<int>(to.size()) != size_) throw std::logic_error("exchange: a list per rank");
    sent_[rank] = std::move(to);
    wait();
    std::vector<std::string> received;
    for (const auto& from : sent_) received.push_back(from[rank]);
    wait();
    return received;
  }

  void fail(std::exception_ptr why) {
    const std::lock_guard lock(mutex_);
    if (!failed_) failed_ = why;
    all_here_.notify_all();
  }
  std::exception_ptr failed() const { return failed_; }

 private:
  void wait() {
    std::unique_lock lock(mutex_);
    const long round = round_;
    if (++here_ == size_) {
      here_ = 0;
      ++round_;
      all_here_.notify_all();
    }
    all_here_.wait(lock, [&] { return round_ != round || failed_; });
    if (failed_) throw std::runtime_error("another rank failed");
  }

  const int size_;
  std::vector<std::vector<std::string>> sent_;
  std::mutex mutex_;
  std::condition_variable all_here_;
  int here_ = 0;
  long round_ = 0;
  std::exception_ptr failed_;
};

class ThreadCommunicator final : public Communicator {
 public:
  ThreadCommunicator(ThreadRanks& ranks, int rank) : ranks_(ranks), rank_(rank) {}

  int rank() const override { return rank_; }
  int size() const override { return ranks_.size(); }
  double sum(double local) const override {
    double total = 0;
    for (const double each : everywhere(local)) total += each;
    return total;
  }
  double max(double local) const override {
    const std::vector<double> all = everywhere(local);
    return *std::max_element(all.begin(), all.end());
  }
  double min(double local) const override { return -max(-local); }
  void max(VecRef values) const override {
    const std::vector<double> mine(values.data(), values.data() + values.size());
    for (const std::vector<double>& other : gather_everywhere(*this, mine))
      for (std::size_t i = 0; i < other.size(); ++i)
        values[static_cast<Eigen::Index>(i)] =
            std::max(values[static_cast<Eigen::Index>(i)], other[i]);
  }
  void update_ghosts(const HaloPlan& plan, VecRef field) const override {
    Lists<double> to(static_cast<std::size_t>(size()));
    Eigen::Index ghost = field.size();
    for (const auto& neighbour : plan.neighbours) {
      for (const int i : neighbour.send) to[neighbour.rank].push_back(field[i]);
      ghost -= neighbour.receive_count;
    }
    const Lists<double> from = exchange_lists(*this, to);
    for (const auto& neighbour : plan.neighbours) {
      const std::vector<double>& values = from[neighbour.rank];
      if (static_cast<int>(values.size()) != neighbour.receive_count)
        throw std::logic_error("a neighbour sends " + std::to_string(values.size()) +
                               " entries, not " + std::to_string(neighbour.receive_count));
      for (const double value : values) field[ghost++] = value;
    }
  }
  std::vector<std::string> exchange(std::vector<std::string> to) const override {
    return ranks_.exchange(rank_, std::move(to));
  }

 private:
  std::vector<double> everywhere(double local) const {
    std::vector<double> all;
    for (const auto& list : gather_everywhere(*this, std::vector<double>{local}))
      all.push_back(list[0]);
    return all;
  }

  ThreadRanks& ranks_;
  const int rank_;
};

using RankBody = std::function<void(std::shared_ptr<const Communicator>)>;

// Runs body on every rank; throws what the first rank to fail threw.
inline void run_on_ranks(int size, const RankBody& body) {
  ThreadRanks ranks(size);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < size; ++rank)
    threads.emplace_back([&, rank] {
      try {
        body(std::make_shared<ThreadCommunicator>(ranks, rank));
      } catch (...) {
        ranks.fail(std::current_exception());
      }
    });
  for (std::thread& thread : threads) thread.join();
  if (ranks.failed()) std::rethrow_exception(ranks.failed());
}

}  // namespace traceraft::testing
