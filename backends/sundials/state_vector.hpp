// State vectors y = (c, μ) as SUNDIALS sees them.
#pragma once

#include <sundials/sundials_nvector.h>

#include <functional>

#include "kernel/core/types.hpp"

namespace traceraft {

// What a norm of SUNDIALS is made of: the norm of one half, independent of the mesh. SUNDIALS' own
// mean over all entries counts a node whose basis function hardly touches the surface like any
// other.
using FieldNorm = std::function<double(ConstVec half)>;

// A zero vector of `size` entries; clones share the norm, which must outlive them. Weighted norms
// take one weight from each half, w[0] and w[size/2] (masks likewise):
//   ‖v‖² = (w_c ‖v_c‖)² + (w_μ ‖v_μ‖)².
// Dot products add in the fixed order of traceraft::dot.
N_Vector new_state_vector(Eigen::Index size, const FieldNorm& norm, SUNContext context);

Eigen::Map<Vec> view(N_Vector v);

}  // namespace traceraft
