// State vectors y = (c, μ) as SUNDIALS sees them.
#pragma once

#include <sundials/sundials_nvector.h>

#include <functional>

#include "kernel/core/communicator.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::sundials {

// The parts that norms and sums of SUNDIALS are made of.
struct StateSpace {
  // The norm of one half, over all ranks and independent of the mesh. SUNDIALS' own mean over all
  // entries counts a node whose basis function hardly touches the surface like any other.
  std::function<double(VecView half)> norm;
  const Communicator& ranks;
};

// A zero vector of `size` entries on this rank; clones share the space, which must outlive them.
// Weighted norms take one weight from each half, w[0] and w[size/2] (masks likewise):
//   ‖v‖² = (w_c ‖v_c‖)² + (w_μ ‖v_μ‖)².
// Dot products add in the fixed order of traceraft::fem::dot, then over the ranks.
N_Vector new_state_vector(Eigen::Index size, const StateSpace& space, SUNContext context);

// The entries of this rank.
Eigen::Map<Vec> view(N_Vector v);

}  // namespace traceraft::sundials
