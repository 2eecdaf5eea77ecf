// The promises of every communicator (kernel/core/communicator.hpp), checked from inside its ranks.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "kernel/core/communicator.hpp"
#include "kernel/core/global_order.hpp"

namespace traceraft::testing {

inline void check_reductions(const Communicator& ranks) {
  const double mine = ranks.rank() + 1, size = ranks.size();
  EXPECT_EQ(ranks.sum(mine), size * (size + 1) / 2);
  EXPECT_EQ(ranks.max(mine), size);
  EXPECT_EQ(ranks.min(mine), 1);
  EXPECT_TRUE(ranks.all(true));
  EXPECT_EQ(ranks.all(ranks.rank() > 0), false);
  EXPECT_TRUE(ranks.any(ranks.rank() == ranks.size() - 1));
  EXPECT_FALSE(ranks.any(false));
  Vec values = Vec::Constant(3, mine);
  values[1] = -mine;
  ranks.max(values);
  EXPECT_EQ(values[0], size);
  EXPECT_EQ(values[1], -1);
}

inline void check_exchange(const Communicator& ranks) {
  // Messages of different lengths, some empty, one with every byte.
  const auto text = [](int from, int to) {
    std::string message(static_cast<std::size_t>(from == to ? 0 : 300 * from + to), '\0');
    for (std::size_t i = 0; i < message.size(); ++i)
      message[i] = static_cast<char>(i + static_cast<std::size_t>(from));
    return message;
  };
  std::vector<std::string> to;
  for (int rank = 0; rank < ranks.size(); ++rank) to.push_back(text(ranks.rank(), rank));
  const std::vector<std::string> from = ranks.exchange(to);
  ASSERT_EQ(from.size(), static_cast<std::size_t>(ranks.size()));
  for (int rank = 0; rank < ranks.size(); ++rank)
    EXPECT_EQ(from[rank], text(rank, ranks.rank())) << rank;
}

// A ring: everybody has the first entry of the next rank and the last of the one before as ghosts.
inline void check_ghosts(const Communicator& ranks) {
  const int size = ranks.size(), me = ranks.rank();
  if (size < 3) return;  // both neighbours are the same one, or none
  constexpr int kOwned = 4;
  const int next = (me + 1) % size, before = (me + size - 1) % size;
  HaloPlan plan;
  plan.neighbours = {{before, {0}, 1}, {next, {kOwned - 1}, 1}};
  if (next < before) std::swap(plan.neighbours[0], plan.neighbours[1]);
  for (int round = 0; round < 3; ++round) {
    Vec field = Vec::Constant(kOwned + 2, -1);
    for (int i = 0; i < kOwned; ++i) field[i] = 100 * me + 10 * round + i;
    ranks.update_ghosts(plan, field);
    for (std::size_t k = 0; k < 2; ++k) {
      const int from = plan.neighbours[k].rank;
      EXPECT_EQ(field[kOwned + static_cast<Eigen::Index>(k)],
                100 * from + 10 * round + (from == next ? 0 : kOwned - 1));
    }
  }
}

inline void check_communicator(const Communicator& ranks) {
  check_reductions(ranks);
  check_exchange(ranks);
  check_ghosts(ranks);
}

}  // namespace traceraft::testing
