// The coarsening law: with constant mobility lengths grow like t^(1/3) (Lifshitz, Slyozov 1961;
// Pego 1989), so the length of all phase boundaries falls like t^(-1/3). With the degenerate
// mobility diffusion along boundaries competes, which has t^(1/4); for this smooth quartic both
// enter at the same order (Lee, Münch, Süli, SIAM J. Appl. Math. 76 (2016)).
#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/bench/dynamic_scaling.hpp"
#include "verification/bench/spherical_spectrum.hpp"
#include "verification/studies/coarsening_laws.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

// Where the law is looked for. It is one of sharp boundaries, L³ = L₀³ + K t: a power law of t only
// once boundaries are thin and t is long against L₀³/K. So there are two windows: a late one, where
// domains are 25 widths of a boundary wide; and one from where the background is absorbed (10
// widths) for a power law whose origin of time is fitted, which early corrections to the law still
// bend. Both end where domains begin to feel the size of the sphere.
constexpr double kWidthsAbsorbed = 10;         // |Γ|/perimeter over ε; kWidthsLate for late
constexpr double kWidthsBetween[] = {15, 20};  // to see what the early ones do
constexpr double kGreatCirclesAtEnd = 3;       // perimeter over 2π

// Where domains are `widths` of a boundary wide and do not yet feel the size of the sphere.
bool in_range(const Ensemble& ensemble, double perimeter, double widths) {
  return 4 * kPi / perimeter >= widths * ensemble.request.epsilon &&
         perimeter >= kGreatCirclesAtEnd * 2 * kPi;
}

statistics::Window window_of_lengths(const Ensemble& ensemble, const std::vector<double>& perimeter,
                                     double widths) {
  return window_where(ensemble.request.times,
                      [&](std::size_t i) { return in_range(ensemble, perimeter[i], widths); });
}

// The spectra of all members at each snapshot in one, over the median degree.
void measure_spectra(const Ensemble& ensemble, const std::string& name, Findings& findings) {
  bench::Chart chart = {
      "Spectrum below a degree, " + name, "l / median", "share", false, false, {}};
  statistics::Points median_degrees;
  std::vector<bench::Cumulative> curves;
  for (std::size_t k = 0; k < ensemble.request.snapshot_times.size(); ++k) {
    std::vector<double> sum(ensemble.members.front().spectra[k].size(), 0);
    for (const bench::Member& member : ensemble.members)
      for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += member.spectra[k][l];
    const double t = ensemble.request.snapshot_times[k];
    median_degrees.emplace_back(t, bench::median_degree(sum));
    curves.push_back(bench::cumulative_spectrum(sum));
    chart.series.push_back({at_time(t), curves.back(), bench::Mark::line});
  }
  findings.report.charts.push_back(chart);
  findings.exponents.rows.push_back({name, "median degree of the spectrum", "t",
                                     median_degrees.front().first, median_degrees.back().first,
                                     statistics::fit_power_law(median_degrees).slope, "", "",
                                     -1.0 / 3});
  findings.report.claims.push_back(
      claim_at_most(name + ": largest difference between the first and the last scaled spectrum",
                    bench::largest_difference(curves.front(), curves.back()), 0.1));
}

void measure_equal(const bench::Bench& bench, const Sizes& sizes, double margin,
                   Findings& findings) {
  const Law perimeter{"50:50, constant mobility", "perimeter", &bench::Member::perimeter, -1.0 / 3};
  // The perimeter reaches three great circles near 0.8/ε.
  bench::EnsembleRequest request = ensemble_request(kConstant, 0.5, sizes, 1 / sizes.epsilon);
  // A boundary has no power beyond 1/ε, nor has the mesh the means to tell.
  request.highest_degree = static_cast<int>(1 / sizes.epsilon);
  for (const double share : {0.1, 0.2, 0.4})
    request.snapshot_times.push_back(share * request.t_end);
  const Ensemble runs = measured_ensemble(bench, perimeter.ensemble, request, findings);
  const std::vector<double> mean = runs.mean(&bench::Member::perimeter);
  const statistics::Window absorbed = window_of_lengths(runs, mean, kWidthsAbsorbed);
  const bench::Exponent shifted =
      measure_law(runs, perimeter, absorbed, bench::Origin::fitted, findings.exponents);
  std::vector<Claim>& claims = findings.report.claims;
  if (bench.quick()) {
    // Boundaries that are wide against the sphere make it smaller; a mobility that vanishes in the
    // phases smaller still.
    claims.push_back(claim_between(perimeter.ensemble + ", wide boundaries: exponent in t + offset",
                                   shifted.b, -0.4, -0.24));
  } else {
    const statistics::Window late = window_of_lengths(runs, mean, kWidthsLate);
    const bench::Exponent plain =
        measure_law(runs, perimeter, late, bench::Origin::zero, findings.exponents);
    for (const double widths : kWidthsBetween)
      (void)measure_law(runs, perimeter, window_of_lengths(runs, mean, widths),
                        bench::Origin::fitted, findings.exponents);
    claims.push_back(exponent_claim(perimeter, "t", plain, margin));
    claims.push_back(interval_claim(perimeter, "t", plain));
    // Its interval knows the scatter between runs, not the widths of early boundaries.
    claims.push_back(exponent_claim(perimeter, "t + offset", shifted, margin));
  }
  const statistics::Points points = as_points(request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart("Length of all phase boundaries, " + perimeter.ensemble, "length (R)",
                       {{"mean of the runs", points, bench::Mark::line},
                        law_line("t^(-1/3)", points, absorbed, -1.0 / 3)}));
  measure_spectra(runs, perimeter.ensemble, findings);
}

// Reported beside the theory, between −1/4 and −1/3, and not claimed.
void measure_degenerate(const bench::Bench& bench, const Sizes& sizes, Findings& findings) {
  const Law perimeter{"50:50, degenerate mobility", "perimeter", &bench::Member::perimeter, -0.25};
  const bench::EnsembleRequest request =
      ensemble_request("degenerate", 0.5, sizes, 4 / sizes.epsilon);
  const Ensemble runs = measured_ensemble(bench, perimeter.ensemble, request, findings);
  const std::vector<double> mean = runs.mean(&bench::Member::perimeter);
  const statistics::Window window = window_of_lengths(runs, mean, kWidthsAbsorbed);
  (void)measure_law(runs, perimeter, window, bench::Origin::fitted, findings.exponents);
  const statistics::Window late = window_of_lengths(runs, mean, kWidthsLate);
  (void)measure_law(runs, perimeter, late, bench::Origin::zero, findings.exponents);
  const statistics::Points points = as_points(request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart("Length of all phase boundaries, " + perimeter.ensemble, "length (R)",
                       {{"mean of the runs", points, bench::Mark::line},
                        law_line("t^(-1/4)", points, window, -0.25),
                        law_line("t^(-1/3)", points, window, -1.0 / 3)}));
}

StudyReport run(const bench::Bench& bench) {
  Findings findings;
  if (bench.quick()) {
    measure_equal(bench, {64, 0.04, 8}, 0.06, findings);
  } else {
    measure_equal(bench, {192, 0.0133, 6, {0, 0.7}}, 0.03, findings);
    measure_degenerate(bench, {160, 0.016, 4, {0.7, 1}}, findings);
  }
  return finished_report(
      findings,
      formatted("Windows of t + offset begin at a length of %.0f widths of a boundary (15 and 20 "
                "also), and windows of t at %.0f widths. They end at a perimeter of %.0f great "
                "circles. Boundaries that are wide compared with lengths make exponents smaller.",
                kWidthsAbsorbed, kWidthsLate, kGreatCirclesAtEnd));
}

}  // namespace

StudyEntry coarsening_study() {
  return {"coarsening", "the t^(-1/3) law of coarsening from ensembles of seeded runs", run};
}

}  // namespace traceraft::studies
