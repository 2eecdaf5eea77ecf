#include <cstdio>

#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "kernel/core/error.hpp"
#include "verification/vesicles/raft_fraction.hpp"

namespace traceraft {
namespace {

void print_mixture(const char* what, const LipidMixture& mixture) {
  std::printf("  %-22s DOPC %.3f, DPPC %.3f, cholesterol %.3f\n", what, mixture.dopc, mixture.dppc,
              mixture.cholesterol);
}

}  // namespace

int fraction_command(const FractionRequest& request) {
  if (request.composition.empty())
    throw InputError("--composition: say what the membrane is made of, such as 3:1:20");
  const LipidMixture membrane = membrane_mixture("--composition", request.composition);
  if (request.ordered.empty() != request.disordered.empty())
    throw InputError("--ordered and --disordered: give both ends of the tie line");
  RaftFractionEstimate estimate;
  if (request.ordered.empty()) {
    estimate = estimated_raft_fraction(membrane, request.celsius);
  } else {
    estimate.phases = CoexistingPhases{phase_mixture("--ordered", request.ordered),
                                       phase_mixture("--disordered", request.disordered)};
    estimate.area = raft_fraction(membrane, *estimate.phases, request.celsius).area;
    estimate.how = "the tie line given";
  }
  print_mixture("membrane", membrane);
  if (estimate.phases) {
    print_mixture("ordered phase (rafts)", estimate.phases->ordered);
    print_mixture("disordered phase", estimate.phases->disordered);
    const double lipids = raft_fraction(membrane, *estimate.phases, request.celsius).lipids;
    std::printf("  %-22s %.3f ordered, %.3f disordered\n", "lipids", lipids, 1 - lipids);
  }
  std::printf("  %-22s %.1f %%  (%s)\n", "raft area fraction", 100 * estimate.area,
              estimate.how.c_str());
  std::printf("\nto simulate it: traceraft run --raft-fraction %.3f\n", estimate.area);
  return kSuccess;
}

}  // namespace traceraft
