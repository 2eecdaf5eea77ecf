// Distributed fields in one order that does not depend on how they are distributed.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/core/communicator.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {

// The order of ascending ids. All functions are collective.
class GlobalOrder {
 public:
  // `ids`: of the entries of this rank, ascending.
  GlobalOrder(const std::vector<std::int64_t>& ids, std::shared_ptr<const Communicator> ranks);

  std::int64_t size() const { return size_; }  // over all ranks
  int local_size() const { return local_size_; }
  const Communicator& ranks() const { return *ranks_; }

  // The whole field on the first rank, nothing on the others.
  Vec gathered(VecView local) const;
  // This rank's part of a field that the first rank gives.
  Vec scattered(VecView whole) const;

 private:
  std::shared_ptr<const Communicator> ranks_;
  int local_size_;
  std::int64_t size_;
  Lists<std::int64_t> position_;  // on the first rank: of the entries of each rank
};

}  // namespace traceraft
