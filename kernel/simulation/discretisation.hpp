// The objects that a run computes with on its present mesh.
#pragma once

#include <memory>

#include "kernel/observables/observables.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::simulation {

// Built in the order of the members; each is handed to the next by reference.
struct Discretisation {
  std::shared_ptr<const fem::SurfaceSpace> space;
  std::unique_ptr<const problem::CahnHilliard> problem;
  std::unique_ptr<const observables::Observer> observer;
  time::IntegratorPtr integrator;
};

}  // namespace traceraft::simulation
