// Local fields of owned ones: the entries that other ranks own added.
#pragma once

#include <memory>

#include "kernel/core/communicator.hpp"
#include "kernel/core/types.hpp"

namespace traceraft {

struct Halo {
  int owned = 0, local = 0;  // entries of a field without and with ghosts
  HaloPlan plan;
  std::shared_ptr<const Communicator> ranks;

  // The field with its ghosts, in `buffer`; refers to `field` where there are none.
  Eigen::Ref<const Vec> with_ghosts(VecView field, Vec& buffer) const {
    if (local == owned) return field;
    buffer.resize(local);
    buffer.head(owned) = field;
    ranks->update_ghosts(plan, buffer);
    return buffer;
  }
};

}  // namespace traceraft
