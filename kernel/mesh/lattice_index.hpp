// Numbers of lattice points, found by their ids.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace traceraft::mesh {

// Open addressing with linear probing: a closure asks for millions of points, most of which are
// not there.
class LatticeIndex {
 public:
  LatticeIndex() { resize(1 << 10); }

  bool contains(std::int64_t id) const { return slots_[slot(id)].id == id; }
  // The number that the point has, or gets now.
  int insert(std::int64_t id, int number) {
    Slot& at = slots_[slot(id)];
    if (at.id == id) return at.number;
    at = {id, number};
    if (2 * ++used_ > slots_.size()) resize(2 * slots_.size());
    return number;
  }

 private:
  struct Slot {
    std::int64_t id = -1;
    int number = -1;
  };

  // Where the point is, or would be. The size is a power of 2.
  std::size_t slot(std::int64_t id) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (static_cast<std::uint64_t>(id) * 0x9E3779B97F4A7C15U >> 20) & mask;
    while (slots_[at].id >= 0 && slots_[at].id != id) at = (at + 1) & mask;
    return at;
  }
  void resize(std::size_t size) {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(size));
    for (const Slot& from : old)
      if (from.id >= 0) slots_[slot(from.id)] = from;
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace traceraft::mesh
