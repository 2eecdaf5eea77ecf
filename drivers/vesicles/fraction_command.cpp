#include <CLI/CLI.hpp>

#include "drivers/commands.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "verification/vesicles/raft_fraction.hpp"

namespace traceraft {
namespace {

struct FractionRequest {
  std::string composition;  // DOPC : DPPC : mol % of cholesterol
  double celsius = 20;
  std::string ordered, disordered;  // mol % of the two phases; "": from what is published
};
void print_mixture(const char* what, const LipidMixture& mixture) {
  say("  %-22s DOPC %.3f, DPPC %.3f, cholesterol %.3f\n", what, mixture.dopc, mixture.dppc,
      mixture.cholesterol);
}

int estimate_fraction(const FractionRequest& request) {
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
  say("  %-22s %g C\n", "temperature", request.celsius);
  if (estimate.phases) {
    print_mixture("ordered phase (rafts)", estimate.phases->ordered);
    print_mixture("disordered phase", estimate.phases->disordered);
    const double lipids = raft_fraction(membrane, *estimate.phases, request.celsius).lipids;
    say("  %-22s %.3f ordered, %.3f disordered\n", "lipids", lipids, 1 - lipids);
    if (estimate.phases->ordered.dppc < estimate.phases->disordered.dppc)
      say("  NOTE: the ordered phase given has less DPPC than the disordered one; are --ordered "
          "and "
          "--disordered the right way round?\n");
  }
  say("  %-22s %.1f %%  (%s)\n", "raft area fraction", 100 * estimate.area, estimate.how);
  say("  areas per lipid are published ones of DOPC; those of DPPC with cholesterol are "
      "FITTED to two published raft fractions\n");
  const std::string own = case_of(request.composition);
  say("\nto simulate it: traceraft run %s --raft-fraction %.3f\n",
      own.empty() ? "--diffusion <D of this membrane in cm^2/s>" : ("--case " + own),
      estimate.area);
  return kSuccess;
}

Action define_fraction(CLI::App& app) {
  const auto request = std::make_shared<FractionRequest>();
  app.add_option("--composition", request->composition,
                 "parts of DOPC : DPPC : mol % of cholesterol, such as 3:1:20; the area of DPPC is "
                 "fitted to what is published of such membranes");
  app.add_option("--temperature", request->celsius, "in degrees Celsius")
      ->check(between(-10, 60))
      ->capture_default_str();
  app.add_option("--ordered", request->ordered,
                 "mol % of DOPC:DPPC:cholesterol in rafts, such as 22:43:35");
  app.add_option("--disordered", request->disordered, "the same around them");
  app.footer("Example: traceraft fraction --composition 2:1:20 --temperature 19.2");
  return [request] { return estimate_fraction(*request); };
}

}  // namespace

Command fraction_command() {
  return {"fraction", "estimate the raft fraction of a lipid composition", Ranks::one,
          define_fraction};
}

}  // namespace traceraft
