// The coarsening law: with constant mobility lengths grow like t^(1/3) (Lifshitz, Slyozov 1961;
// Pego 1989), so the length of all phase boundaries falls like t^(-1/3) and the number of rafts
// like t^(-2/3). With the degenerate mobility diffusion along boundaries competes, which has
// t^(1/4); for this smooth quartic both enter at the same order (Lee, Münch, Süli, SIAM J. Appl.
// Math. 76 (2016)).
#include <cmath>
#include <cstdint>

#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"
#include "verification/measure/coarsening_laws.hpp"
#include "verification/measure/dynamic_scaling.hpp"
#include "verification/measure/spherical_spectrum.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

// Where the law is looked for. It is one of sharp boundaries, L³ = L₀³ + K t: a power law of t only
// once boundaries are thin and t is long against L₀³/K. So there are two windows: a late one, where
// domains are 25 widths of a boundary wide; and one from where the background is absorbed (10
// widths) for a power law whose origin of time is fitted, which early corrections to the law still
// bend. Both end where domains begin to feel the size of the sphere.
constexpr double kWidthsLate = 25, kWidthsAbsorbed = 10;  // |Γ|/perimeter over ε
constexpr double kGreatCirclesAtEnd = 3;                  // perimeter over 2π
constexpr double kRaftsAtEnd = 12;                        // for laws of rafts

constexpr const char* kConstant = "constant:value=0.25";

struct Sizes {
  int cells;
  double epsilon;
  int members;
  Part part = {};  // of the time that all of them take
};

EnsembleRequest ensemble_request(const std::string& mobility, double fraction, const Sizes& sizes,
                                 double t_end) {
  EnsembleRequest request;
  request.mobility = mobility;
  request.raft_fraction = fraction;
  request.cells = sizes.cells;
  request.epsilon = sizes.epsilon;
  request.members = sizes.members;
  request.tolerance = 1e-2;  // 1e-3 gives nearly the same rafts (docs/decisions/0013)
  request.t_end = t_end;
  request.part = sizes.part;
  constexpr int kPerDecade = 24;
  for (double t = 0.1; t <= t_end; t *= std::pow(10.0, 1.0 / kPerDecade))
    request.times.push_back(t);
  return request;
}

// Where domains are `widths` of a boundary wide and do not yet feel the size of the sphere.
bool in_range(const Ensemble& ensemble, double perimeter, double widths) {
  return 4 * kPi / perimeter >= widths * ensemble.request.epsilon &&
         perimeter >= kGreatCirclesAtEnd * 2 * kPi;
}

Window window_of_lengths(const Ensemble& ensemble, const std::vector<double>& perimeter,
                         double widths) {
  return window_where(ensemble.request.times,
                      [&](std::size_t i) { return in_range(ensemble, perimeter[i], widths); });
}

std::string at_time(double t) {
  return formatted("t = %.3g", t);
}

// One row for each size of ensemble: what the laws cost.
void add_cost(const Ensemble& ensemble, const std::string& name, double seconds, Table& cost) {
  double steps = 0;
  for (const Member& member : ensemble.members)
    steps += member.steps / static_cast<double>(ensemble.members.size());
  const EnsembleRequest& request = ensemble.request;
  cost.rows.push_back({name, static_cast<double>(request.cells), request.epsilon,
                       10.0 / 3 / request.cells / request.epsilon,
                       static_cast<double>(request.members), request.t_end, steps, seconds});
}

struct Findings {
  StudyReport report;
  Table exponents = exponents_table();
  Table cost{
      "cost",
      {"ensemble", "cells", "epsilon", "h/epsilon", "members", "t_end", "steps each", "wall_s"},
      {}};
};

Ensemble measured_ensemble(const Bench& bench, const std::string& name,
                           const EnsembleRequest& request, Findings& findings) {
  const Stopwatch watch;
  Ensemble ensemble(bench, request);
  add_cost(ensemble, name, watch.seconds(), findings.cost);
  return ensemble;
}

// The spectra of all members at each snapshot in one, over the mean degree.
void measure_spectra(const Ensemble& ensemble, const std::string& name, Findings& findings) {
  Chart chart = {"Spectrum below a degree, " + name, "l / <l>", "share", false, false, {}};
  Points mean_degrees;
  std::vector<Cumulative> curves;
  for (std::size_t k = 0; k < ensemble.request.snapshot_times.size(); ++k) {
    std::vector<double> sum(ensemble.members.front().spectra[k].size(), 0);
    for (const Member& member : ensemble.members)
      for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += member.spectra[k][l];
    const double t = ensemble.request.snapshot_times[k];
    mean_degrees.emplace_back(t, mean_degree(sum));
    curves.push_back(cumulative_spectrum(sum));
    chart.series.push_back({at_time(t), curves.back(), Mark::line});
  }
  findings.report.charts.push_back(chart);
  findings.exponents.rows.push_back({name, "mean degree of the spectrum", "t",
                                     mean_degrees.front().first, mean_degrees.back().first,
                                     fit_power_law(mean_degrees).slope, "", "", -1.0 / 3});
  findings.report.claims.push_back(
      claim_at_most(name + ": scaled spectra, largest difference of first and last",
                    largest_difference(curves.front(), curves.back()), 0.1));
}

void measure_equal(const Bench& bench, const Sizes& sizes, double margin, Findings& findings) {
  const Law perimeter{"50:50, constant mobility", "perimeter", &Member::perimeter, -1.0 / 3};
  // The perimeter reaches three great circles near 0.8/ε.
  EnsembleRequest request = ensemble_request(kConstant, 0.5, sizes, 1 / sizes.epsilon);
  // A boundary has no power beyond 1/ε, nor has the mesh the means to tell.
  request.highest_degree = static_cast<int>(1 / sizes.epsilon);
  for (const double share : {0.1, 0.2, 0.4})
    request.snapshot_times.push_back(share * request.t_end);
  const Ensemble runs = measured_ensemble(bench, perimeter.ensemble, request, findings);
  const std::vector<double> mean = runs.mean(&Member::perimeter);
  const Window absorbed = window_of_lengths(runs, mean, kWidthsAbsorbed);
  const Exponent shifted =
      measure_law(runs, perimeter, absorbed, Origin::fitted, findings.exponents);
  std::vector<Claim>& claims = findings.report.claims;
  if (bench.quick()) {
    // Boundaries that are wide against the sphere make it smaller; a mobility that vanishes in the
    // phases smaller still.
    claims.push_back(claim_between(perimeter.ensemble + ", wide boundaries: exponent in t + offset",
                                   shifted.b, -0.4, -0.24));
  } else {
    const Window late = window_of_lengths(runs, mean, kWidthsLate);
    const Exponent plain = measure_law(runs, perimeter, late, Origin::zero, findings.exponents);
    claims.push_back(exponent_claim(perimeter, "t + offset", shifted, margin));
    claims.push_back(interval_claim(perimeter, "t + offset", shifted));
    claims.push_back(exponent_claim(perimeter, "t", plain, margin));
    claims.push_back(interval_claim(perimeter, "t", plain));
  }
  const Points points = as_points(request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart("Length of all phase boundaries, " + perimeter.ensemble, "length (R)",
                       {{"mean of the runs", points, Mark::line},
                        law_line("t^(-1/3)", points, absorbed, -1.0 / 3)}));
  measure_spectra(runs, perimeter.ensemble, findings);
}

// Reported beside the theory, between −1/4 and −1/3, and not claimed.
void measure_degenerate(const Bench& bench, const Sizes& sizes, Findings& findings) {
  const Law perimeter{"50:50, degenerate mobility", "perimeter", &Member::perimeter, -0.25};
  const EnsembleRequest request = ensemble_request("degenerate", 0.5, sizes, 4 / sizes.epsilon);
  const Ensemble runs = measured_ensemble(bench, perimeter.ensemble, request, findings);
  const std::vector<double> mean = runs.mean(&Member::perimeter);
  const Window window = window_of_lengths(runs, mean, kWidthsAbsorbed);
  (void)measure_law(runs, perimeter, window, Origin::fitted, findings.exponents);
  const Window late = window_of_lengths(runs, mean, kWidthsLate);
  (void)measure_law(runs, perimeter, late, Origin::zero, findings.exponents);
  const Points points = as_points(request.times, mean);
  findings.report.charts.push_back(
      coarsening_chart("Length of all phase boundaries, " + perimeter.ensemble, "length (R)",
                       {{"mean of the runs", points, Mark::line},
                        law_line("t^(-1/4)", points, window, -0.25),
                        law_line("t^(-1/3)", points, window, -1.0 / 3)}));
}

// Radii over their mean, of the rafts of all members together, at the snapshots.
void measure_sizes(const Ensemble& runs, const std::string& name, Findings& findings) {
  Chart chart = {
      "Rafts smaller than a radius, " + name, "radius / mean", "share", false, false, {}};
  std::vector<Cumulative> curves;
  for (std::size_t k = 0; k < runs.request.snapshot_times.size(); ++k) {
    std::vector<double> areas;
    for (const Member& member : runs.members)
      areas.insert(areas.end(), member.areas[k].begin(), member.areas[k].end());
    curves.push_back(cumulative_radii(areas));
    chart.series.push_back({at_time(runs.request.snapshot_times[k]), curves.back(), Mark::line});
  }
  findings.report.charts.push_back(chart);
  findings.report.claims.push_back(
      claim_at_most(name + ": scaled radii, difference of first and last over that of chance (5 %)",
                    largest_difference(curves.front(), curves.back()) /
                        critical_difference(curves.front().size() - 1, curves.back().size() - 1),
                    1));
}

// Rafts are counted from where domains are wide, as the plain law of lengths is; early ones are of
// one size and wait for each other.
void measure_rafts(const Bench& bench, const Sizes& sizes, double margin, Findings& findings) {
  const std::string name = "30 %, constant mobility";
  EnsembleRequest request = ensemble_request(kConstant, 0.3, sizes, 0.6 / sizes.epsilon);
  for (const double share : {0.05, 0.2, 0.6})
    request.snapshot_times.push_back(share * request.t_end);
  const Ensemble runs = measured_ensemble(bench, name, request, findings);
  const std::vector<double> perimeter = runs.mean(&Member::perimeter);
  const std::vector<double> count = runs.mean(&Member::rafts);
  const Window window = window_where(request.times, [&](std::size_t i) {
    return 4 * kPi / perimeter[i] >= kWidthsLate * sizes.epsilon && count[i] >= kRaftsAtEnd;
  });
  const Points points = as_points(request.times, count);
  Points radius = as_points(request.times, runs.mean(&Member::raft_radius));
  for (auto& [t, value] : radius) value *= 100;
  findings.report.charts.push_back(
      coarsening_chart("Number and radius of rafts, " + name, "number, 100 radius/R",
                       {{"number", points, Mark::line},
                        law_line("t^(-2/3)", points, window, -2.0 / 3),
                        {"100 radius", radius, Mark::line},
                        law_line("t^(1/3)", radius, window, 1.0 / 3)}));
  for (const Law& law : {Law{name, "number of rafts", &Member::rafts, -2.0 / 3},
                         Law{name, "mean raft radius", &Member::raft_radius, 1.0 / 3}}) {
    const Exponent found = measure_law(runs, law, window, Origin::fitted, findings.exponents);
    findings.report.claims.push_back(
        exponent_claim(law, "t + offset", found, 3 * margin * std::fabs(law.theory)));
    findings.report.claims.push_back(interval_claim(law, "t + offset", found));
    (void)measure_law(runs, law, window, Origin::zero, findings.exponents);
  }
  measure_sizes(runs, name, findings);
}

StudyReport run(const Bench& bench) {
  Findings findings;
  const double margin = bench.quick() ? 0.06 : 0.03;
  if (bench.quick()) {
    measure_equal(bench, {64, 0.04, 8}, margin, findings);
  } else {
    measure_equal(bench, {192, 0.0133, 6, {0, 0.3}}, margin, findings);
    measure_degenerate(bench, {192, 0.0133, 4, {0.3, 0.5}}, findings);
    measure_rafts(bench, {224, 0.0114, 6, {0.5, 1}}, margin, findings);
  }
  findings.report.notes = {formatted(
      "Seeded runs; intervals are by the bootstrap over runs and hold their scatter, not "
      "corrections to the law. A length is |Gamma|/perimeter: windows of t + offset begin where it "
      "is %.0f widths, those of t and of rafts at %.0f; they end at a perimeter of %.0f great "
      "circles, or %.0f rafts.",
      kWidthsAbsorbed, kWidthsLate, kGreatCirclesAtEnd, kRaftsAtEnd)};
  findings.report.tables = {findings.exponents, findings.cost};
  return findings.report;
}

}  // namespace

StudyEntry coarsening_study() {
  return {"coarsening", "the t^(-1/3) law of coarsening from ensembles of seeded runs", run};
}

}  // namespace traceraft
