// What the pieces cost, and how that grows with the mesh.
#include <algorithm>
#include <memory>

#include "backends/posix/process.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/fem/mobility_stiffness.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies.hpp"

namespace traceraft {
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
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[repetitions / 2];
}

StudyReport run(const StudyRequest& request) {
  StudyReport report;
  report.columns = {"cells",      "tets",        "nodes",    "setup_ms",   "peak_MB",
                    "product_ms", "assemble_ms", "products", "residual_ms"};
  const auto team = std::make_shared<ThreadTeam>(1);
  const auto communicator = std::make_shared<SerialCommunicator>();
  for (int cells = 64; cells <= (request.quick ? 128 : 512); cells *= 2) {
    const Stopwatch watch;
    const auto space =
        std::make_shared<SurfaceSpace>(*make_surface("sphere"), cells, team, communicator);
    const double setup = watch.seconds();
    const double peak = peak_memory_mb();
    CahnHilliardModel model;
    model.mobility = make_mobility("degenerate");
    model.epsilon = 2 * space->h();
    const CahnHilliard problem(space, model);
    Vec y = Vec::Zero(problem.size()), ydot = Vec::Zero(problem.size()), r(problem.size());
    const int n = problem.block_size();
    y.head(n) = make_initial_field("noise", *space, {});
    Vec product(n);
    CsrMatrix matrix(space->pattern);
    const double one_product =
        median_seconds(21, [&] { space->mass.multiply(y.head(n), product, *team); });
    const double assembly = median_seconds(21, [&] {
      assemble_mobility_stiffness(*space, mobility_integrals(*space, *model.mobility, y.head(n)),
                                  matrix);
    });
    const double residual = median_seconds(11, [&] { (void)problem.residual(0, y, ydot, r); });
    report.rows.push_back({static_cast<double>(cells), static_cast<double>(space->elements.size()),
                           static_cast<double>(n), 1e3 * setup, peak, 1e3 * one_product,
                           1e3 * assembly, assembly / one_product, 1e3 * residual});
  }
  const auto& fine = report.rows.back();
  const auto& coarse = report.rows[report.rows.size() - 2];
  report.claims = {{"nodes, 2n to n (4: grows like the surface)", fine[2] / coarse[2], 3.9, 4.1},
                   {"set-up time, 2n to n (4: like the surface)", fine[3] / coarse[3], 0, 6},
                   {"assembly of K_M in products (at most 3 x 3)", fine[7], 0, 9}};
  return report;
}

}  // namespace

StudyEntry operation_cost_study() {
  return {"cost", "time and memory of set-up, products and assembly over the mesh size", run, true};
}

}  // namespace traceraft
