// Rafts as discs against the field: energies, perimeters and numbers of the same vesicles.
#include <cmath>

#include "kernel/core/text.hpp"
#include "kernel/effects/brownian_flow.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "kernel/observables/resolved_boundary.hpp"
#include "verification/bench/disc_vesicle.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr int kRafts = 8;
constexpr double kSpread = 0.3, kFraction = 0.16;

struct DiscSizes {
  double epsilon;
  int cells, vesicles;
  std::vector<double> times;
  flow::FluidMembrane membrane = {};  // thermal = 0: there is no flow
};

// At the times.
using VesicleHistory = std::vector<observables::Observables>;

VesicleHistory in_field(const bench::Bench& bench, const DiscSizes& sizes, std::uint64_t seed) {
  const bench::SpacePtr space = bench.space(geometry::make_surface("sphere"), sizes.cells, 1);
  problem::CahnHilliardModel model = bench::bench_model("degenerate", sizes.epsilon);
  if (sizes.membrane.thermal > 0)
    model.effects = {
        std::make_shared<effects::CapillaryFlow>(sizes.membrane, sizes.epsilon),
        std::make_shared<effects::BrownianFlow>(
            sizes.membrane, sizes.epsilon, flow::hold_of(sizes.membrane, sizes.epsilon), seed)};
  const bench::ProblemPtr problem = bench.problem(space, model);
  const observables::Observer observer(
      *problem, space,
      observables::resolved_boundary(problem->model(), space->h()).interface_energy);
  problem::InitialRequest request;
  request.raft_fraction = kFraction;
  request.seed = seed;
  const bench::StartState start = bench::initial_state(
      *problem, formatted("discs:number=%d,spread=%g", kRafts, kSpread), request);
  const time::IntegratorPtr integrator = bench.default_integrator(*problem, 1e-3);
  VesicleHistory history;
  Vec y(problem->size());
  bench::advance_to(*integrator, start, sizes.times.back(), [&] {
    for (; history.size() < sizes.times.size() &&
           sizes.times[history.size()] <= integrator->time();) {
      bench::require(integrator->interpolate(sizes.times[history.size()], y));
      history.push_back(observer.measure(sizes.times[history.size()], y));
    }
  });
  return history;
}

// `walk`: the seed of Brownian motion.
VesicleHistory as_discs(const bench::Bench& bench, const DiscSizes& sizes, std::uint64_t seed,
                        std::uint64_t walk = 1) {
  discs::DiscModel model;
  model.mobility = physics::make_mobility("degenerate");
  model.epsilon = sizes.epsilon;
  model.membrane = sizes.membrane;
  model.seed = walk;
  discs::RandomDiscs asked;
  asked.number = kRafts;
  asked.spread = kSpread;
  asked.raft_fraction = kFraction;
  asked.epsilon = sizes.epsilon;
  asked.seed = seed;
  return bench::follow_discs(bench, model, asked, 1e-3, sizes.times);
}

// The mean of a number over pairs of vesicles at one time, and its standard error.
struct PairMean {
  double mean, error;
};
template <class Number>
PairMean over_pairs(const std::vector<VesicleHistory>& fields,
                    const std::vector<VesicleHistory>& discs, std::size_t at,
                    const Number& number) {
  std::vector<double> values;
  for (std::size_t k = 0; k < fields.size(); ++k)
    values.push_back(number(fields[k][at], discs[k][at]));
  const statistics::Sample sample = statistics::sample_of(values);
  return {sample.mean, sample.deviation / std::sqrt(static_cast<double>(values.size()))};
}

void compare(const bench::Bench& bench, const DiscSizes& sizes, bench::Part part,
             StudyReport& report) {
  using Row = const observables::Observables&;
  std::vector<VesicleHistory> fields(static_cast<std::size_t>(sizes.vesicles)), discs = fields;
  bench.in_parallel(
      sizes.vesicles,
      [&](int k) {
        const auto index = static_cast<std::size_t>(k);
        fields[index] = in_field(bench, sizes, index + 1);
        discs[index] = as_discs(bench, sizes, index + 1);
      },
      part);
  const std::string name = formatted("epsilon = %g R", sizes.epsilon);
  bench::Table table{
      name,
      {"t", "rafts, field", "more in discs", "standard error", "perimeter, discs / field",
       "standard error", "energy, discs / field", "standard error"},
      {}};
  double perimeters = 0, energies = 0, most = 0;
  for (std::size_t i = 0; i < sizes.times.size(); ++i) {
    const PairMean count = over_pairs(fields, discs, i, [](Row f, Row) { return 1.0 * f.rafts; }),
                   more = over_pairs(fields, discs, i,
                                     [](Row f, Row d) { return 1.0 * (d.rafts - f.rafts); }),
                   perimeter = over_pairs(fields, discs, i,
                                          [](Row f, Row d) { return d.perimeter / f.perimeter; }),
                   energy = over_pairs(fields, discs, i,
                                       [](Row f, Row d) { return d.energy / f.energy; });
    table.rows.push_back({sizes.times[i], count.mean, more.mean, more.error, perimeter.mean,
                          perimeter.error, energy.mean, energy.error});
    const auto share = 1 / static_cast<double>(sizes.times.size());
    perimeters += share * perimeter.mean;
    energies += share * energy.mean;
    most = statistics::larger(most, std::fabs(more.mean));
  }
  report.tables.push_back(table);
  report.claims.push_back(claim_near(name + ": perimeter, discs / field, mean over the times",
                                     perimeters, 1, bench.quick() ? 0.03 : 0.05));
  report.claims.push_back(claim_near(name + ": energy, discs / field, mean over the times",
                                     energies, 1, bench.quick() ? 0.01 : 0.05));
  report.claims.push_back(
      claim_at_most(name + ": largest mean difference in the number of rafts", most, 1));
}

// The mean of a quantity over vesicles, and its standard error.
template <class Quantity>
PairMean over_vesicles(const std::vector<VesicleHistory>& all, std::size_t at,
                       const Quantity& quantity) {
  return over_pairs(all, all, at,
                    [&](const observables::Observables& one, const observables::Observables&) {
                      return quantity(one);
                    });
}

struct FlowMeans {
  PairMean rafts_in_field, rafts_in_discs, perimeter_in_field, ratio;  // of perimeters
};
FlowMeans means_at(const std::vector<VesicleHistory>& fields,
                   const std::vector<VesicleHistory>& discs, std::size_t at) {
  using Row = const observables::Observables&;
  const auto rafts = [](Row row) { return 1.0 * row.rafts; };
  const auto perimeter = [](Row row) { return row.perimeter; };
  const PairMean of_field = over_vesicles(fields, at, perimeter),
                 of_discs = over_vesicles(discs, at, perimeter);
  const double ratio = of_discs.mean / of_field.mean;
  return {
      over_vesicles(fields, at, rafts),
      over_vesicles(discs, at, rafts),
      of_field,
      {ratio, ratio * std::hypot(of_field.error / of_field.mean, of_discs.error / of_discs.mean)}};
}

// The standard error of the mean over the times of the perimeter, each over its mean over vesicles.
double error_of_perimeter(const std::vector<VesicleHistory>& fields) {
  std::vector<double> mean(fields.size(), 0.0);
  for (std::size_t i = 0; i < fields.front().size(); ++i) {
    double sum = 0;
    for (const VesicleHistory& field : fields) sum += field[i].perimeter;
    for (std::size_t k = 0; k < fields.size(); ++k)
      mean[k] += fields[k][i].perimeter * static_cast<double>(fields.size()) / sum /
                 static_cast<double>(fields.front().size());
  }
  return statistics::sample_of(mean).deviation / std::sqrt(static_cast<double>(fields.size()));
}

// Brownian motion is drawn, in the field for each vesicle and in discs for each walk. So means are
// compared: discs make many walks from each start, and what is left is the scatter of the field.
void compare_with_flow(const bench::Bench& bench, const DiscSizes& sizes, int walks,
                       bench::Part part, StudyReport& report) {
  std::vector<VesicleHistory> fields(static_cast<std::size_t>(sizes.vesicles)), discs;
  for (int k = 0; k < sizes.vesicles * walks; ++k)
    discs.push_back(as_discs(bench, sizes, static_cast<std::uint64_t>(k / walks) + 1,
                             static_cast<std::uint64_t>(k) + 1));
  bench.in_parallel(
      sizes.vesicles,
      [&](int k) {
        const auto index = static_cast<std::size_t>(k);
        fields[index] = in_field(bench, sizes, index + 1);
      },
      part);
  bench::Table table{
      "with flow",
      {"t", "rafts, field", "standard error", "rafts, discs", "standard error", "perimeter, field",
       "standard error", "perimeter, discs / field", "standard error"},
      {}};
  double perimeters = 0, more = 0, error = 0;
  const auto share = 1 / static_cast<double>(sizes.times.size());
  for (std::size_t i = 0; i < sizes.times.size(); ++i) {
    const auto [rafts_in_field, rafts_in_discs, perimeter, ratio] = means_at(fields, discs, i);
    table.rows.push_back({sizes.times[i], rafts_in_field.mean, rafts_in_field.error,
                          rafts_in_discs.mean, rafts_in_discs.error, perimeter.mean,
                          perimeter.error, ratio.mean, ratio.error});
    perimeters += share * ratio.mean;
    more += share * (rafts_in_discs.mean - rafts_in_field.mean);
    error += share * rafts_in_field.error;
  }
  report.tables.push_back(table);
  const double known = 2 * error_of_perimeter(fields);
  report.claims.push_back(claim_near("with flow: perimeter, discs / field, mean over the times",
                                     perimeters, 1, 0.05 + known, known));
  report.claims.push_back(claim_near("with flow: more rafts in discs, mean over the times", more, 0,
                                     0.5 + 2 * error, 2 * error));
}

StudyReport run_discs(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      formatted("%d rafts at random places, raft fraction %g, degenerate mobility. Discs and "
                "field begin with the same rafts; errors are those of the mean over vesicles.",
                kRafts, kFraction)};
  if (bench.quick()) {
    compare(bench, {0.03, 56, 4, {2, 5, 10}}, {}, report);
    return report;
  }
  compare(bench, {0.03, 80, 8, {2, 5, 10, 20, 50, 100, 200}}, {0, 0.2}, report);
  compare(bench, {0.02, 112, 8, {4.5, 11, 22, 45, 112, 225, 450}}, {0.2, 0.6}, report);
  compare_with_flow(bench, {0.03, 56, 10, {1, 2, 4, 8, 16}, {1e4, 1.25, 0.05}}, 30, {0.6, 1},
                    report);
  return report;
}

}  // namespace

StudyEntry rafts_as_discs_study() {
  return {"discs", "rafts as discs against the field: energies, perimeters, numbers", run_discs};
}

}  // namespace traceraft::studies
