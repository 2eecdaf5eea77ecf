// The cost of the pieces, and how it grows with the mesh.
#include <algorithm>

#include "backends/posix/process.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/effects/capillary_flow.hpp"
#include "kernel/fem/mobility_stiffness.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

// Median seconds of an action over some repetitions.
template <class Action>
double median_seconds(int repetitions, const Action& action) {
  std::vector<double> times;
  for (int i = 0; i < repetitions; ++i) {
    const Stopwatch watch;
    action();
    times.push_back(watch.seconds());
  }
  return statistics::quantile(times, 0.5);
}

// A membrane that flows, over one that does not: a residual, and a run to the same time.
void measure_flow(const bench::Bench& bench, StudyReport& report) {
  const int cells = bench.quick() ? 64 : 128;
  const double epsilon = 6.4 / cells, t_end = 0.5;
  const bench::SpacePtr space = bench.space(geometry::make_surface("sphere"), cells, 1);
  problem::CahnHilliardModel model = bench::bench_model("degenerate", epsilon);
  const bench::ProblemPtr without = bench.problem(space, model);
  model.effects = {
      std::make_shared<effects::CapillaryFlow>(flow::FluidMembrane{1000, 1.25, 0}, epsilon)};
  const bench::ProblemPtr with = bench.problem(space, model);
  problem::InitialRequest request;
  request.raft_fraction = 0.4;
  const auto residual = [&](const problem::CahnHilliard& problem) {
    const bench::StartState start = bench::initial_state(problem, "noise", request);
    Vec r(problem.size());
    return median_seconds(21, [&] { (void)problem.residual(0, start.y, start.ydot, r); });
  };
  const auto run_to_end = [&](const problem::CahnHilliard& problem) {
    const bench::StartState start = bench::initial_state(problem, "noise", request);
    const time::IntegratorPtr integrator = bench.default_integrator(problem, 1e-3);
    const Stopwatch watch;
    bench::advance_to(*integrator, start, t_end);
    return std::pair(watch.seconds(), static_cast<double>(integrator->statistics().steps));
  };
  const auto [plain, plain_steps] = run_to_end(*without);
  const auto [flowing, flowing_steps] = run_to_end(*with);
  const double residual_ratio = residual(*with) / residual(*without);
  report.tables.push_back({"flow",
                           {"cells", "epsilon", "residual, with / without",
                            "run to t = 0.5, with / without", "steps with", "steps without"},
                           {{static_cast<double>(cells), epsilon, residual_ratio, flowing / plain,
                             flowing_steps, plain_steps}}});
  report.claims.push_back(
      claim_at_most("time of a residual with capillary flow / without", residual_ratio, 3));
  report.claims.push_back(
      claim_at_most("time of a run with capillary flow / without", flowing / plain, 3));
}

StudyReport run(const bench::Bench& bench) {
  bench::Table table{"cost",
                     {"cells", "tets", "nodes", "setup_ms", "peak_MB", "product_ms", "assemble_ms",
                      "products", "residual_ms"},
                     {}};
  std::vector<std::array<double, 3>> levels;  // nodes, set-up, assembly in products
  for (int cells = 64; cells <= (bench.quick() ? 128 : 512); cells *= 2) {
    const Stopwatch watch;
    const bench::SpacePtr space = bench.space(geometry::make_surface("sphere"), cells, 1);
    const double setup = watch.seconds(), peak = posix::peak_memory_mb();
    const bench::ProblemPtr problem =
        bench.problem(space, bench::bench_model("degenerate", 2 * space->h()));
    const int n = problem->block_size();
    Vec y = Vec::Zero(problem->size()), ydot = y, r(problem->size()), product(n);
    y.head(n) = problem::make_initial_field("noise", *space, {});
    fem::CsrMatrix matrix(space->pattern);
    const double one_product =
        median_seconds(21, [&] { space->mass.multiply(y.head(n), product, *space->team); });
    const double assembly = median_seconds(21, [&] {
      const physics::Mobility& mobility = *problem->model().mobility;
      fem::assemble_mobility_stiffness(*space, fem::mobility_integrals(*space, mobility, y.head(n)),
                                       matrix);
    });
    const double residual = median_seconds(11, [&] { (void)problem->residual(0, y, ydot, r); });
    table.rows.push_back({static_cast<double>(cells), static_cast<double>(space->elements.size()),
                          static_cast<double>(n), 1e3 * setup, peak, 1e3 * one_product,
                          1e3 * assembly, assembly / one_product, 1e3 * residual});
    levels.push_back({static_cast<double>(n), setup, assembly / one_product});
  }
  const auto& fine = levels.back();
  const auto& coarse = levels[levels.size() - 2];
  StudyReport report;
  report.notes = {
      "The column products is the time to assemble K_M (the stiffness matrix weighted by the "
      "mobility), divided by the time of one matrix-vector product."};
  report.tables = {table};
  report.claims = {
      claim_near("number of nodes, 2n cells / n cells (4 like the surface)", fine[0] / coarse[0], 4,
                 0.1),
      claim_between("set-up time, 2n cells / n cells (4 like the surface)", fine[1] / coarse[1], 0,
                    6),
      claim_between("time to assemble K_M / time of a product (at most 3 x 3)", fine[2], 0, 9)};
  measure_flow(bench, report);
  return report;
}

}  // namespace

StudyEntry operation_cost_study() {
  return {"cost", "time and memory of set-up, products and assembly over the mesh size", run, true};
}

}  // namespace traceraft::studies
