#include "kernel/core/global_order.hpp"

#include <algorithm>
#include <cmath>

namespace traceraft {

GlobalOrder::GlobalOrder(const std::vector<std::int64_t>& ids,
                         std::shared_ptr<const Communicator> ranks)
    : ranks_(std::move(ranks)),
      local_size_(static_cast<int>(ids.size())),
      size_(std::llround(ranks_->sum(static_cast<double>(ids.size())))) {
  if (ranks_->size() == 1) return;
  position_ = gather(*ranks_, ids);
  std::vector<std::int64_t> all;
  for (const auto& of_rank : position_) all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end());
  for (auto& of_rank : position_)
    for (std::int64_t& id : of_rank)
      id = std::lower_bound(all.begin(), all.end(), id) - all.begin();
}

Vec GlobalOrder::gathered(VecView local) const {
  if (ranks_->size() == 1) return local;
  const Lists<double> parts =
      gather(*ranks_, std::vector<double>(local.data(), local.data() + local.size()));
  Vec whole(ranks_->root() ? size_ : 0);
  for (std::size_t rank = 0; rank < parts.size(); ++rank)
    for (std::size_t i = 0; i < parts[rank].size(); ++i) whole[position_[rank][i]] = parts[rank][i];
  return whole;
}

Vec GlobalOrder::scattered(VecView whole) const {
  if (ranks_->size() == 1) return whole;
  Lists<double> parts;
  for (const auto& of_rank : position_) {
    parts.emplace_back();
    for (const std::int64_t at : of_rank) parts.back().push_back(whole[at]);
  }
  const std::vector<double> mine = scatter(*ranks_, parts);
  return Eigen::Map<const Vec>(mine.data(), static_cast<Eigen::Index>(mine.size()));
}

}  // namespace traceraft
