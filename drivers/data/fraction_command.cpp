#include <CLI/CLI.hpp>

#include "drivers/commands.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "verification/observations/raft_fraction.hpp"

namespace traceraft::data {
namespace {

struct FractionRequest {
  std::string composition;  // DOPC : DPPC : mol % of cholesterol
  double celsius = 20;
  std::string ordered, disordered;  // mol % of the two phases; "": from what is published
};
void print_mixture(const char* what, const observations::LipidMixture& mixture) {
  text::say("  %-22s DOPC %.3f, DPPC %.3f, cholesterol %.3f\n", what, mixture.dopc, mixture.dppc,
            mixture.cholesterol);
}

int estimate_fraction(const FractionRequest& request) {
  if (request.composition.empty())
    throw InputError("--composition: the composition of the membrane is needed, such as 3:1:20");
  const observations::LipidMixture membrane =
      observations::membrane_mixture("--composition", request.composition);
  if (request.ordered.empty() != request.disordered.empty())
    throw InputError("--ordered and --disordered: both ends of the tie line are needed");
  observations::RaftFractionEstimate estimate;
  if (request.ordered.empty()) {
    estimate = observations::estimated_raft_fraction(membrane, request.celsius);
  } else {
    estimate.phases = observations::CoexistingPhases{
        observations::phase_mixture("--ordered", request.ordered),
        observations::phase_mixture("--disordered", request.disordered)};
    estimate.area = observations::raft_fraction(membrane, *estimate.phases, request.celsius).area;
    estimate.how = "the given tie line";
  }
  print_mixture("membrane", membrane);
  text::say("  %-22s %g C\n", "temperature", request.celsius);
  if (estimate.phases) {
    print_mixture("ordered phase (rafts)", estimate.phases->ordered);
    print_mixture("disordered phase", estimate.phases->disordered);
    const double lipids =
        observations::raft_fraction(membrane, *estimate.phases, request.celsius).lipids;
    text::say("  %-22s %.3f ordered, %.3f disordered\n", "lipids", lipids, 1 - lipids);
    if (estimate.phases->ordered.dppc < estimate.phases->disordered.dppc)
      text::say(
          "  NOTE: this ordered phase has less DPPC than the disordered phase. Are --ordered and "
          "--disordered exchanged?\n");
  }
  text::say("  %-22s %.1f %%  (%s)\n", "raft area fraction", 100 * estimate.area, estimate.how);
  text::say(
      "  The area per lipid of DOPC is published. That of DPPC with cholesterol is FITTED to two "
      "published raft fractions.\n");
  const std::string own = input::case_of(request.composition);
  text::say("\nto simulate it: traceraft run %s --raft-fraction %.3f\n",
            own.empty() ? "--diffusion <D of this membrane in cm^2/s>" : ("--case " + own),
            estimate.area);
  return drivers::kSuccess;
}

drivers::Action define_fraction(CLI::App& app) {
  const auto request = std::make_shared<FractionRequest>();
  app.add_option("--composition", request->composition,
                 "composition of the membrane as DOPC:DPPC:cholesterol, such as 3:1:20: parts of "
                 "DOPC and DPPC, and mol % of cholesterol");
  app.add_option("--temperature", request->celsius, "temperature in degrees Celsius")
      ->check(config::between(-10, 60))
      ->capture_default_str();
  app.add_option("--ordered", request->ordered,
                 "composition of the ordered phase (rafts) in mol %, as DOPC:DPPC:cholesterol, "
                 "such as 22:43:35");
  app.add_option("--disordered", request->disordered,
                 "composition of the disordered phase in mol %, as DOPC:DPPC:cholesterol");
  app.footer("Example: traceraft fraction --composition 2:1:20 --temperature 19.2");
  return [request] { return estimate_fraction(*request); };
}

}  // namespace

drivers::Command fraction_command() {
  return {"fraction", "estimate the raft fraction of a lipid composition", drivers::Ranks::one,
          define_fraction};
}

}  // namespace traceraft::data
