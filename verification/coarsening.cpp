// The coarsening law: with constant mobility lengths grow like t^(1/3) (Lifshitz, Slyozov 1961;
// Pego 1989), so the length of all phase boundaries falls like t^(-1/3) and the number of rafts
// like t^(-2/3). With the degenerate mobility diffusion along boundaries competes, which has
// t^(1/4); for this smooth quartic both enter at the same order (Lee, Münch, Süli, SIAM J. Appl.
// Math. 76 (2016)).
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/text.hpp"
#include "verification/ensemble.hpp"
#include "verification/spherical_spectrum.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

// Where the law is looked for. L³ = L₀³ + K t is a power law of t only once t is long against
// L₀³/K, so there are two windows: a late one, where domains are 25 widths of a boundary wide, for
// a plain power law; and one from where the background is absorbed (10 widths) for a power law
// whose origin of time is fitted. Both end where domains begin to feel the size of the sphere.
constexpr double kWidthsLate = 25, kWidthsAbsorbed = 10;  // |Γ|/perimeter over ε
constexpr double kGreatCirclesAtEnd = 3;                  // perimeter over 2π
constexpr double kRaftsAtEnd = 12;                        // for laws of rafts

struct Sizes {
  int cells;
  double epsilon;
  int members;
};

std::vector<double> logarithmic(double begin, double end, int per_decade) {
  std::vector<double> times;
  const int count = static_cast<int>(std::floor(std::log10(end / begin) * per_decade));
  for (int i = 0; i <= count; ++i)
    times.push_back(begin * std::pow(10.0, static_cast<double>(i) / per_decade));
  return times;
}

struct Window {
  double begin, end;
};

// From the first time at which `holds` to the last at which it does.
template <class Holds>
Window window_where(const std::vector<double>& times, const Holds& holds) {
  Window window{times.back(), times.back()};
  bool found = false;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!holds(i)) continue;
    if (!found) window.begin = times[i];
    window.end = times[i];
    found = true;
  }
  return window;
}

// Long enough to fit a law in.
bool usable(const Window& window) {
  return window.end >= 3 * window.begin;
}

Points as_points(const std::vector<double>& times, const std::vector<double>& values) {
  Points points;
  for (std::size_t i = 0; i < times.size(); ++i) points.emplace_back(times[i], values[i]);
  return points;
}

// A straight line of the given exponent through the middle of the window.
ChartSeries law(const std::string& name, const Points& points, const Window& window, double b) {
  const double middle = std::sqrt(window.begin * window.end);
  const auto near =
      std::min_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
        return std::fabs(std::log(p.first / middle)) < std::fabs(std::log(q.first / middle));
      });
  const auto at = [&](double t) { return near->second * std::pow(t / near->first, b); };
  return {name, {{window.begin, at(window.begin)}, {window.end, at(window.end)}}, Mark::line};
}

struct Law {
  std::string ensemble, quantity;
  std::vector<double> Member::*values;
  double theory;
};

Exponent fit(const std::vector<Member>& members, const EnsembleRequest& request, const Law& law,
             const Window& window, Origin origin, Table& table) {
  if (!usable(window))
    throw std::runtime_error("the window of the " + law.quantity + " is too short to fit a law");
  const Exponent found =
      fit_exponent(members, law.values, request.times, window.begin, window.end, origin);
  table.rows.push_back({law.ensemble, law.quantity,
                        origin == Origin::zero ? "t" : formatted("t + %.3g", found.offset),
                        window.begin, window.end, found.b, found.interval.low, found.interval.high,
                        law.theory});
  return found;
}

Claim exponent_claim(const Law& law, const char* of, const Exponent& found, double margin) {
  return claim_near(law.ensemble + ": exponent of the " + law.quantity + " in " + of, found.b,
                    law.theory, margin, 0.5 * (found.interval.high - found.interval.low));
}

// The spectra of all members at each snapshot, over the mean degree: one curve if they scale.
Chart scaling_chart(const std::vector<Member>& members, const EnsembleRequest& request,
                    Points& mean_degrees) {
  Chart chart{"Spectrum over the mean degree", "l / <l>", "<l> S_l / sum S", true, true, {}};
  for (std::size_t k = 0; k < request.snapshot_times.size(); ++k) {
    std::vector<double> sum(members.front().spectra[k].size(), 0);
    for (const Member& member : members)
      for (std::size_t l = 0; l < sum.size(); ++l) sum[l] += member.spectra[k][l];
    const double mean = mean_degree(sum);
    mean_degrees.emplace_back(request.snapshot_times[k], mean);
    double total = 0;
    for (std::size_t l = 1; l < sum.size(); ++l) total += sum[l];
    Points curve;
    for (std::size_t l = 1; l < sum.size(); ++l)
      curve.emplace_back(static_cast<double>(l) / mean, mean * sum[l] / total);
    chart.series.push_back({formatted("t = %.3g", request.snapshot_times[k]), curve, Mark::line});
  }
  return chart;
}

EnsembleRequest ensemble(const std::string& mobility, double fraction, const Sizes& sizes) {
  EnsembleRequest request;
  request.mobility = mobility;
  request.raft_fraction = fraction;
  request.cells = sizes.cells;
  request.epsilon = sizes.epsilon;
  request.members = sizes.members;
  // The perimeter reaches three great circles near 0.8/ε, later with the degenerate mobility.
  request.t_end = (mobility == "degenerate" ? 4 : 1) / sizes.epsilon;
  request.times = logarithmic(0.1, request.t_end, 24);
  return request;
}

// Where domains are `widths` of a boundary wide and do not yet feel the size of the sphere.
Window window_of_lengths(const EnsembleRequest& request, const std::vector<double>& perimeter,
                         double widths) {
  return window_where(request.times, [&](std::size_t i) {
    return 4 * kPi / perimeter[i] >= widths * request.epsilon &&
           perimeter[i] >= kGreatCirclesAtEnd * 2 * kPi;
  });
}

Chart coarsening_chart(const std::string& title, const std::string& y_label,
                       std::vector<ChartSeries> series) {
  return {title, "t (R^2/D)", y_label, true, true, std::move(series)};
}

void measure_equal(const Bench& bench, const Sizes& sizes, double margin, Table& table,
                   StudyReport& report) {
  EnsembleRequest request = ensemble("constant:value=0.25", 0.5, sizes);
  request.highest_degree = 60;
  for (const double share : {0.1, 0.3, 0.8})
    request.snapshot_times.push_back(share * request.t_end);
  const std::vector<Member> members = run_ensemble(bench, request);
  const std::vector<double> mean = geometric_mean(members, &Member::perimeter, everyone(members));
  const Law perimeter{"50:50, constant mobility", "perimeter", &Member::perimeter, -1.0 / 3};
  const Window absorbed = window_of_lengths(request, mean, kWidthsAbsorbed);
  const Window late = window_of_lengths(request, mean, kWidthsLate);
  const Exponent shifted = fit(members, request, perimeter, absorbed, Origin::fitted, table);
  if (bench.quick()) {
    // Boundaries that are wide against the sphere make it smaller; a mobility that vanishes in the
    // phases smaller still.
    report.claims.push_back(
        claim_between("50:50, constant mobility, wide boundaries: exponent in t + offset",
                      shifted.b, -0.4, -0.24));
  } else {
    report.claims.push_back(exponent_claim(perimeter, "t + offset", shifted, margin));
    report.claims.push_back(claim_between("-1/3 lies in its 95 % interval (1: yes)",
                                          shifted.interval.contains(-1.0 / 3), 1, 1));
    const Exponent plain = fit(members, request, perimeter, late, Origin::zero, table);
    report.claims.push_back(exponent_claim(perimeter, "t", plain, margin));
    report.claims.push_back(claim_between("-1/3 lies in its 95 % interval (1: yes)",
                                          plain.interval.contains(-1.0 / 3), 1, 1));
  }
  const Points points = as_points(request.times, mean);
  report.charts.push_back(coarsening_chart(
      "Length of all phase boundaries, 50:50, constant mobility", "length (R)",
      {{"mean of the runs", points, Mark::line}, law("t^(-1/3)", points, absorbed, -1.0 / 3)}));
  Points degrees;
  report.charts.push_back(scaling_chart(members, request, degrees));
  table.rows.push_back({perimeter.ensemble, "mean degree of the spectrum", "t",
                        degrees.front().first, degrees.back().first, fit_power_law(degrees).slope,
                        "", "", -1.0 / 3});
}

// Reported beside the theory, between −1/4 and −1/3, and not claimed.
void measure_degenerate(const Bench& bench, const Sizes& sizes, Table& table, StudyReport& report) {
  const EnsembleRequest request = ensemble("degenerate", 0.5, sizes);
  const std::vector<Member> members = run_ensemble(bench, request);
  const std::vector<double> mean = geometric_mean(members, &Member::perimeter, everyone(members));
  const Window window = window_of_lengths(request, mean, kWidthsAbsorbed);
  const Law perimeter{"50:50, degenerate mobility", "perimeter", &Member::perimeter, -0.25};
  for (const Origin origin : {Origin::zero, Origin::fitted})
    (void)fit(members, request, perimeter, window, origin, table);
  const Points points = as_points(request.times, mean);
  report.charts.push_back(
      coarsening_chart("Length of all phase boundaries, 50:50, degenerate mobility", "length (R)",
                       {{"mean of the runs", points, Mark::line},
                        law("t^(-1/4)", points, window, -0.25),
                        law("t^(-1/3)", points, window, -1.0 / 3)}));
}

void measure_rafts(const Bench& bench, const Sizes& sizes, double margin, Table& table,
                   StudyReport& report) {
  EnsembleRequest request = ensemble("constant:value=0.25", 0.3, sizes);
  const std::vector<Member> members = run_ensemble(bench, request);
  const std::vector<double> count = geometric_mean(members, &Member::rafts, everyone(members));
  const std::size_t most =
      static_cast<std::size_t>(std::max_element(count.begin(), count.end()) - count.begin());
  const Window window = window_where(request.times, [&](std::size_t i) {
    return request.times[i] >= 4 * request.times[most] && count[i] >= kRaftsAtEnd;
  });
  const Points points = as_points(request.times, count);
  Points radius =
      as_points(request.times, geometric_mean(members, &Member::raft_radius, everyone(members)));
  for (auto& [t, value] : radius) value *= 100;
  report.charts.push_back(coarsening_chart("Number and radius of rafts, 30 %, constant mobility",
                                           "number, 100 radius/R",
                                           {{"number", points, Mark::line},
                                            law("t^(-2/3)", points, window, -2.0 / 3),
                                            {"100 radius", radius, Mark::line},
                                            law("t^(1/3)", radius, window, 1.0 / 3)}));
  for (const Law& law :
       {Law{"30 %, constant mobility", "number of rafts", &Member::rafts, -2.0 / 3},
        Law{"30 %, constant mobility", "mean raft radius", &Member::raft_radius, 1.0 / 3}}) {
    const Exponent found = fit(members, request, law, window, Origin::fitted, table);
    report.claims.push_back(
        exponent_claim(law, "t + offset", found, 3 * margin * std::fabs(law.theory)));
    (void)fit(members, request, law, window, Origin::zero, table);
  }
}

StudyReport run(const Bench& bench) {
  const Sizes sizes = bench.quick() ? Sizes{64, 0.04, 8} : Sizes{192, 0.0133, 6};
  const double margin = bench.quick() ? 0.06 : 0.03;
  StudyReport report;
  report.notes = {formatted(
      "%d cells, width %.4g (h/width %.2f), %d seeds each, intervals by the bootstrap over "
      "runs. Windows end at a length of three great circles, or 12 rafts.",
      sizes.cells, sizes.epsilon, 10.0 / 3 / sizes.cells / sizes.epsilon, sizes.members)};
  Table table{"exponents",
              {"ensemble", "quantity", "law of", "from", "to", "exponent", "low", "high", "theory"},
              {}};
  measure_equal(bench, sizes, margin, table, report);
  if (!bench.quick()) {
    measure_degenerate(bench, sizes, table, report);
    measure_rafts(bench, sizes, margin, table, report);
  }
  report.tables.push_back(table);
  return report;
}

}  // namespace

StudyEntry coarsening_study() {
  return {"coarsening", "the t^(-1/3) law of coarsening from ensembles of seeded runs", run};
}

}  // namespace traceraft
