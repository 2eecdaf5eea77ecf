// Coarsening of membranes that flow (Camley, Brown, J. Chem. Phys. 135 (2011)). Where the drag of
// the water dominates, line tension lets the lengths of both phases, if they are equal, grow like
// t^(1/2). Round rafts that meet by Brownian motion grow like t^(1/3), as they diffuse like
// 1/radius. Where the membrane dominates, their diffusion hardly depends on the radius (Saffman,
// Delbrück), and they grow like t^(1/2), but for a logarithm that makes them slower.
#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "verification/bench/disc_vesicle.hpp"
#include "verification/studies/coarsening_laws.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

// Where the length is at least 0.36 R, up to two great circles of perimeter.
constexpr double kShortest = 0.36, kGreatCirclesAtEnd = 2;

// Flow is slower here than boundaries restore their profile, and faster than diffusion. Round
// domains coarsen slower than others, so that there is no law that the whole window obeys: its
// exponent is told, and that flow coarsens.
void measure_equal(const bench::Bench& bench, const Sizes& sizes, Findings& findings) {
  const std::string name = "50:50, line tension moves the water";
  constexpr double kEnd = 4, kTheory = -0.5, kCapillary = 900;  // over epsilon
  bench::EnsembleRequest request = ensemble_request("degenerate", 0.5, sizes, kEnd);
  request.times = times_between(1e-2, kEnd);
  const Ensemble plain = measured_ensemble(bench, "50:50, no flow", request, findings);
  request.effects = {std::make_shared<effects::CapillaryFlow>(
      flow::FluidMembrane{kCapillary / sizes.epsilon, 30, 0}, sizes.epsilon)};
  const Ensemble runs = measured_ensemble(bench, name, request, findings);
  const std::vector<double> mean = runs.mean(&bench::Member::perimeter),
                            without = plain.mean(&bench::Member::perimeter);
  const statistics::Window window = window_where(request.times, [&](std::size_t i) {
    return 4 * kPi / mean[i] >= kShortest && mean[i] >= kGreatCirclesAtEnd * 2 * kPi;
  });
  const bench::Exponent found =
      bench::fit_exponent(runs.members, &bench::Member::perimeter, request.times, window.begin,
                          window.end, bench::Origin::zero);
  findings.exponents.rows.push_back({name, "perimeter", "t", window.begin, window.end, found.b,
                                     found.interval.low, found.interval.high, kTheory});
  findings.report.claims.push_back(claim_at_most("50:50: perimeter at the end, with flow / without",
                                                 mean.back() / without.back(), 0.6));
  const statistics::Points points = as_points(request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart("Perimeter, both phases equal", "perimeter / R",
                       {{"with flow", points, bench::Mark::line},
                        {"without", as_points(request.times, without), bench::Mark::line},
                        law_line("t^(-1/2)", points, window, kTheory)}));
}

// Discs without ripening to speak of: Brownian motion is fast.
Ensemble meeting_discs(const bench::Bench& bench, double water, int rafts, int vesicles) {
  constexpr double kEnd = 20;
  bench::EnsembleRequest request;
  request.epsilon = 0.002;
  request.times = times_between(1e-4 * kEnd, kEnd);
  std::vector<bench::Member> members(static_cast<std::size_t>(vesicles));
  bench.in_parallel(vesicles, [&](int k) {
    discs::DiscModel model;
    model.mobility = physics::make_mobility("degenerate");
    model.epsilon = request.epsilon;
    model.membrane = {0, water, 1};
    model.seed = static_cast<std::uint64_t>(k) + 1;
    discs::RandomDiscs start;
    start.number = rafts;
    start.spread = 0.2;
    start.raft_fraction = 0.1;
    start.epsilon = request.epsilon;
    start.seed = model.seed;
    bench::Member& member = members[static_cast<std::size_t>(k)];
    for (const observables::Observables& at :
         bench::follow_discs(bench, model, start, 1e-2, request.times)) {
      member.rafts.push_back(static_cast<double>(at.rafts));
      member.perimeter.push_back(at.perimeter);
    }
  });
  return {request, std::move(members)};
}

struct Regime {
  const char* name;
  double water, theory, margin;
};

void measure_meeting(const bench::Bench& bench, const Regime& regime, Findings& findings) {
  constexpr double kFewest = 8;  // fewer feel the size of the sphere
  const int rafts = bench.quick() ? 100 : 300;
  const Ensemble runs = meeting_discs(bench, regime.water, rafts, bench.quick() ? 4 : 16);
  const Law law{regime.name, "number of rafts", &bench::Member::rafts, regime.theory};
  const std::vector<double> mean = runs.mean(law.values);
  const statistics::Window window = window_where(runs.request.times, [&](std::size_t i) {
    return mean[i] >= kFewest && mean[i] <= 0.5 * rafts;
  });
  const bench::Exponent found =
      measure_law(runs, law, window, bench::Origin::fitted, findings.exponents);
  findings.report.claims.push_back(exponent_claim(law, "t + offset", found, regime.margin));
  const statistics::Points points = as_points(runs.request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart(std::string("Number of rafts, ") + regime.name, "number",
                       {{"rafts", points, bench::Mark::line},
                        law_line(formatted("t^(%.2g)", law.theory), points, window, law.theory)}));
}

StudyReport run(const bench::Bench& bench) {
  Findings findings;
  if (bench.quick())
    measure_equal(bench, {64, 0.045, 2}, findings);
  else
    measure_equal(bench, {96, 0.03, 6}, findings);
  const double margin = bench.quick() ? 0.15 : 0.08;
  measure_meeting(bench, {"discs, drag of the water", 100, -2.0 / 3, margin}, findings);
  measure_meeting(bench, {"discs, drag of the membrane", 0.05, -1, 0.2}, findings);
  return finished_report(
      findings,
      formatted("Windows begin at a length of %g R, or where half of the rafts are left. The "
                "exponent of equal phases has no claim: theirs is no law of the whole window, as "
                "round domains coarsen slower than others.",
                kShortest));
}

}  // namespace

StudyEntry flow_coarsening_study() {
  return {"flow-coarsening", "coarsening of membranes that flow: lengths like t^(1/2) and t^(1/3)",
          run};
}

}  // namespace traceraft::studies
