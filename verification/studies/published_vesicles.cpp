// Published perimeters of vesicles, beside rafts that ripen, and rafts that also meet in a membrane
// with the viscosity that others measured. Nothing is fitted.
#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/bench/disc_vesicle.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/studies/coarsening_laws.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

// Zhiliakov, Wang, Quaini, Olshanskii, Majd, BBA Biomembranes 1863 (2021) 183446: the power law of
// the perimeter over the radius (t in s), the raft fraction, and the D (µm²/s) of their
// simulations.
struct Published {
  std::string composition, file_id;
  statistics::PowerLaw perimeter;
  double fraction, diffusion;
  int discs;  // as many as fit at the start
};
const Published kPublished[] = {{"2:1", "2to1", {49, 4.69, -0.34, 0}, 0.157, 2500, 100},
                                {"3:1", "3to1", {53, 21.1, -0.37, 0}, 0.09, 1000, 40}};

// R and ε in µm. Viscosities in nPa s m: DOPC 4.1 ± 2.6, SOPC 9.7 ± 5.8. The D of lipids in µm²/s,
// k_B T at 20 °C in pN µm, and the viscosity of water in mPa s.
constexpr double kRadius = 5, kEpsilon = 0.05, kOfLipids = 5, kThermal = 4.05e-3, kWater = 1;
constexpr double kLessViscous = 4.1, kMoreViscous = 9.7;

struct Membrane {
  double diffusion, viscosity;  // 0: it does not flow
};

discs::DiscModel model_of(const Membrane& membrane) {
  discs::DiscModel model;
  model.mobility = physics::make_mobility("degenerate");
  model.epsilon = kEpsilon / kRadius;
  if (membrane.viscosity > 0) {
    const double viscosity = 1e-3 * membrane.viscosity;  // pN s/µm
    model.membrane = {0, kRadius * 1e-3 * kWater / viscosity,
                      kThermal / (viscosity * membrane.diffusion)};
  }
  return model;
}

// Geometric means of the perimeter over the radius at the times (s).
std::vector<double> mean_perimeters(const bench::Bench& bench, const Published& published,
                                    const Membrane& membrane, const std::vector<double>& times,
                                    bench::Part part) {
  const int vesicles = bench.quick() ? 8 : 64;
  std::vector<double> own_times;
  for (const double t : times) own_times.push_back(t * membrane.diffusion / (kRadius * kRadius));
  std::vector<std::vector<double>> logarithms(static_cast<std::size_t>(vesicles));
  bench.in_parallel(
      vesicles,
      [&](int k) {
        discs::DiscModel model = model_of(membrane);
        model.seed = static_cast<std::uint64_t>(k + 1);
        discs::RandomDiscs start;
        start.number = published.discs;
        start.raft_fraction = published.fraction;
        start.epsilon = model.epsilon;
        start.seed = model.seed;
        constexpr double kTolerance = 5e-3;
        for (const observables::Observables& row :
             bench::follow_discs(bench, model, start, kTolerance, own_times))
          logarithms[static_cast<std::size_t>(k)].push_back(std::log(row.perimeter));
      },
      part);
  std::vector<double> means(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    double sum = 0;
    for (const std::vector<double>& own : logarithms) sum += own[i];
    means[i] = std::exp(sum / vesicles);
  }
  return means;
}

// From 100 to 316 s, the first and the fourth of the times.
double slope(const std::vector<double>& times, const std::vector<double>& values) {
  return statistics::fit_power_law({{times[0], values[0]}, {times[3], values[3]}}).slope;
}

void compare(const bench::Bench& bench, const Published& published, bench::Part part,
             bench::Chart& chart, StudyReport& report) {
  const std::vector<double> times{100, 147, 215, 316, 464, 681, 1000};  // s
  std::vector<double> law;
  for (const double t : times) law.push_back(published.perimeter.at(t));
  const double third = (part.to - part.from) / 3;
  const auto simulated = [&](int k, const Membrane& membrane) {
    return mean_perimeters(bench, published, membrane, times,
                           {part.from + k * third, part.from + (k + 1) * third});
  };
  const std::vector<double> ripening = simulated(0, {published.diffusion, 0}),
                            less = simulated(1, {kOfLipids, kLessViscous}),
                            more = simulated(2, {kOfLipids, kMoreViscous});
  bench::Table table{published.file_id,
                     {"t (s)", "published", "without flow", formatted("%g nPa s m", kLessViscous),
                      formatted("%g nPa s m", kMoreViscous)},
                     {}};
  double squares_without = 0, squares_with = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    table.rows.push_back({times[i], law[i], ripening[i], less[i], more[i]});
    const auto share = 1 / static_cast<double>(times.size());
    squares_without += share * std::pow(std::log(ripening[i] / law[i]), 2);
    squares_with += share * std::pow(std::log(std::sqrt(less[i] * more[i]) / law[i]), 2);
  }
  report.tables.push_back(table);
  const std::string name = published.composition + ": ";
  const double with = std::sqrt(squares_with), without = std::sqrt(squares_without);
  report.claims.push_back(
      claim_at_most(name + "root mean square of ln, both viscosities over published", with,
                    bench.quick() ? 0.25 : 0.2));
  if (!bench.quick())
    report.claims.push_back(
        claim_at_most(name + "the same over that without flow", with / without, 0.8));
  report.notes.push_back(formatted(
      "%s slopes of ln from 100 to 316 s are %.2f published, %.2f without flow, %.2f and %.2f with "
      "it. The root mean square without flow is %.2f.",
      name.c_str(), slope(times, law), slope(times, ripening), slope(times, less),
      slope(times, more), without));
  chart.series.push_back(
      {published.composition + " published", as_points(times, law), bench::Mark::both});
  chart.series.push_back(
      {published.composition + " without flow", as_points(times, ripening), bench::Mark::line});
  chart.series.push_back({published.composition + " with flow, 4.1 to 9.7 nPa s m",
                          as_points(times, less), bench::Mark::band, more});
}

StudyReport run_published(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {formatted(
      "R = %g um, epsilon = %g um. Without flow D is that of the paper's simulations, which was "
      "chosen to fit; with flow it is %g um^2/s, that of lipids, and viscosities are those that "
      "others measured, so that nothing is fitted.",
      kRadius, kEpsilon, kOfLipids)};
  bench::Chart chart{"Perimeter over radius: published, and simulated without a fit",
                     "time (s)",
                     "perimeter / radius",
                     true,
                     true,
                     {}};
  compare(bench, kPublished[0], {0, 0.5}, chart, report);
  compare(bench, kPublished[1], {0.5, 1}, chart, report);
  report.charts.push_back(chart);
  return report;
}

}  // namespace

StudyEntry published_vesicles_study() {
  return {"published",
          "perimeters of published vesicles, by rafts that ripen and by rafts that also meet",
          run_published};
}

}  // namespace traceraft::studies
