// Rafts that grow: with constant mobility their number falls like t^(-2/3) and their radius grows
// like t^(1/3) (Lifshitz, Slyozov 1961), and in units of their mean their radii keep one
// distribution.
#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/bench/dynamic_scaling.hpp"
#include "verification/studies/coarsening_laws.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kRaftsAtEnd = 12;  // fewer feel the size of the sphere

// Radii over their mean, of the rafts of all members together, at the snapshots.
void measure_sizes(const Ensemble& runs, const std::string& name, Findings& findings) {
  bench::Chart chart = {
      "Rafts smaller than a radius, " + name, "radius / mean", "share", false, false, {}};
  std::vector<bench::Cumulative> curves;
  std::vector<std::vector<std::vector<double>>> by_member;
  for (std::size_t k = 0; k < runs.request.snapshot_times.size(); ++k) {
    std::vector<double> areas;
    by_member.emplace_back();
    for (const bench::Member& member : runs.members) {
      areas.insert(areas.end(), member.areas[k].begin(), member.areas[k].end());
      by_member.back().push_back(member.areas[k]);
    }
    curves.push_back(bench::cumulative_radii(areas));
    chart.series.push_back(
        {at_time(runs.request.snapshot_times[k]), curves.back(), bench::Mark::line});
  }
  findings.report.charts.push_back(chart);
  findings.report.claims.push_back(
      claim_at_most(name + ": difference between first and last distribution of scaled radii / 5 % "
                           "quantile of chance",
                    bench::largest_difference(curves.front(), curves.back()) /
                        bench::chance_difference(by_member.front(), by_member.back()),
                    1));
}

// Rafts are counted from where domains are wide, as the plain law of lengths is; early ones are of
// one size and wait for each other.
void measure_rafts(const bench::Bench& bench, const Sizes& sizes, double margin,
                   Findings& findings) {
  const std::string name = "30 %, constant mobility";
  bench::EnsembleRequest request = ensemble_request(kConstant, 0.3, sizes, 0.6 / sizes.epsilon);
  for (const double share : {0.05, 0.2, 0.6})
    request.snapshot_times.push_back(share * request.t_end);
  const Ensemble runs = measured_ensemble(bench, name, request, findings);
  const std::vector<double> perimeter = runs.mean(&bench::Member::perimeter);
  const std::vector<double> count = runs.mean(&bench::Member::rafts);
  const statistics::Window window = window_where(request.times, [&](std::size_t i) {
    return 4 * kPi / perimeter[i] >= kWidthsLate * sizes.epsilon && count[i] >= kRaftsAtEnd;
  });
  const statistics::Points points = as_points(request.times, count);
  statistics::Points radius = as_points(request.times, runs.mean(&bench::Member::raft_radius));
  for (auto& [t, value] : radius) value *= 100;
  findings.report.charts.push_back(
      coarsening_chart("Number and radius of rafts, " + name, "number, 100 radius/R",
                       {{"number", points, bench::Mark::line},
                        law_line("t^(-2/3)", points, window, -2.0 / 3),
                        {"100 radius", radius, bench::Mark::line},
                        law_line("t^(1/3)", radius, window, 1.0 / 3)}));
  for (const Law& law : {Law{name, "number of rafts", &bench::Member::rafts, -2.0 / 3},
                         Law{name, "mean raft radius", &bench::Member::raft_radius, 1.0 / 3}}) {
    const bench::Exponent found =
        measure_law(runs, law, window, bench::Origin::fitted, findings.exponents);
    findings.report.claims.push_back(
        exponent_claim(law, "t + offset", found, 3 * margin * std::fabs(law.theory)));
    findings.report.claims.push_back(interval_claim(law, "t + offset", found));
    (void)measure_law(runs, law, window, bench::Origin::zero, findings.exponents);
  }
  measure_sizes(runs, name, findings);
}

StudyReport run(const bench::Bench& bench) {
  Findings findings;
  if (bench.quick())
    measure_rafts(bench, {96, 0.0267, 5}, 0.06, findings);
  else
    measure_rafts(bench, {256, 0.01, 6}, 0.03, findings);
  return finished_report(
      findings,
      formatted("Windows begin at a length of %.0f widths of a boundary and end at %.0f rafts.",
                kWidthsLate, kRaftsAtEnd));
}

}  // namespace

StudyEntry raft_coarsening_study() {
  return {"coarsening-rafts", "number and size of rafts: t^(-2/3), t^(1/3), scaling of their sizes",
          run, true};
}

}  // namespace traceraft::studies
