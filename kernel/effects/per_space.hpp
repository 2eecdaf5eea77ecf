// A value that an effect computes once for each space that its model is used on.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "kernel/fem/surface_space.hpp"

namespace traceraft::effects {

// Threads may ask at the same time. Spaces are told apart by their patterns, which they do not
// share: an address may be that of one that is gone.
template <class Value>
class PerSpace {
 public:
  using Compute = std::function<std::shared_ptr<const Value>(const fem::SurfaceSpace&)>;
  explicit PerSpace(Compute compute) : compute_(std::move(compute)) {}

  std::shared_ptr<const Value> on(const fem::SurfaceSpace& space) {
    const std::lock_guard lock(mutex_);
    if (const auto known = values_.find(space.pattern); known != values_.end())
      return known->second;
    for (auto it = values_.begin(); it != values_.end();)
      it = it->first.expired() ? values_.erase(it) : std::next(it);
    return values_[space.pattern] = compute_(space);
  }

 private:
  const Compute compute_;
  std::mutex mutex_;
  std::map<std::weak_ptr<const fem::SparsityPattern>, std::shared_ptr<const Value>,
           std::owner_less<>>
      values_;
};

}  // namespace traceraft::effects
