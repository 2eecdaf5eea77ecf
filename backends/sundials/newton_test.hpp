// When Newton's method has converged: after its first correction, if experience says so.
#pragma once

#include "kernel/core/checkpoint_stream.hpp"

namespace traceraft::sundials {

// Each correction is computed with the exact Jacobian of its iterate, up to the tolerance of the
// linear solver. What the first one, of norm d, leaves is therefore about
// (η + C d) d, and the norm of a second correction measures it. Because η and C change slowly from
// step to step, one step in a few shows whether the others need a second correction at all.
//
// IDA's own test does the same with a rate that it keeps while its Jacobian is frozen. With an
// exact Jacobian that rate is never measured again: it accepted nearly every first correction, lost
// accuracy where nonlinearity matters, and made later steps fail.
class NewtonTest {
 public:
  enum class Verdict { converged, go_on, diverges };

  // After correction number `iteration` (from 0) of a step; the norm of what is left is to be
  // below `bound`.
  Verdict judge(int iteration, double norm, double bound);
  void save(CheckpointOut out) const;
  void load(CheckpointIn in);

 private:
  bool trusted_for(double norm, double bound) const;

  struct Experience {
    double rate = 1;   // norm of the second correction over that of the first,
    double norm = 0;   // which had this norm
    int steps = 1000;  // that relied on it since
  };
  Experience experience_;
  double first_ = 0;  // norm of the first correction of this step
};

}  // namespace traceraft::sundials
