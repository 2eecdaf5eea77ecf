// Orders of convergence in the step size, and errors against the tolerance, on one mesh against a
// run with far smaller steps.
#include <cmath>

#include "verification/analytic/manufactured.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kEnd = 1.0;

struct Method {
  const char* name;
  const char* integrator;
  const char* kept;  // euler only
  double order, margin;
};
constexpr Method kMethods[] = {{"stabilised Euler", "euler", "first", 1, 0.15},
                               {"stabilised BDF2", "euler", "second", 2, 0.25},
                               {"ida at maximum order 2", "ida", "", 2, 0.25},
                               {"rosenbrock", "rosenbrock", "", 3, 0.25}};

class Runs {
 public:
  explicit Runs(const bench::Bench& bench)
      : bench_(bench), manufactured_(bench, bench.space("sphere", 16), "sphere", 0.3) {}

  Vec with_steps(const Method& method, int steps) const {
    time::IntegratorSettings settings;
    settings.tolerance = 0.5;  // all steps of the size asked for
    settings.initial_step = settings.max_step = kEnd / steps;
    settings.linear_tolerance = 1e-12;
    settings.kept_solution = method.kept;
    if (method.integrator == std::string("ida")) settings.method_options["maxord"] = method.order;
    return solve(method.integrator, settings);
  }
  Vec with_tolerance(const std::string& integrator, double tolerance) const {
    time::IntegratorSettings settings;
    settings.tolerance = tolerance;
    return solve(integrator, settings);
  }
  double error(const Vec& y, const Vec& reference) const {
    return manufactured_.problem->norm(y - reference);
  }

 private:
  Vec solve(const std::string& name, const time::IntegratorSettings& settings) const {
    const time::IntegratorPtr integrator = bench_.make_integrator(
        *manufactured_.problem, manufactured_.space(), name, bench_.linear_solver(), settings);
    bench::advance_to(*integrator, manufactured_.initial_state(), kEnd);
    return integrator->state();
  }

  const bench::Bench& bench_;
  analytic::ManufacturedCahnHilliard manufactured_;
};

bool chosen(const bench::Bench& bench, const Method& method) {
  return bench.request.integrator.empty() || bench.request.integrator == method.integrator;
}

void measure_orders(const bench::Bench& bench, const Runs& runs, const Vec& reference,
                    StudyReport& report) {
  const int finest = bench.quick() ? 160 : 320;
  bench::Table table{"steps", {"method", "steps", "error"}, {}};
  bench::Chart chart{
      "Error against the size of the step", "step", "error of c in L2", true, true, {}};
  for (const Method& method : kMethods) {
    if (!chosen(bench, method)) continue;
    statistics::Points levels;
    // The smallest errors of order 3, near 1e-10, are at the accuracy of the solves.
    const int most = method.order < 3 ? finest : finest / 4;
    for (int steps = most / (method.order < 3 ? 8 : 4); steps <= most; steps *= 2) {
      levels.emplace_back(kEnd / steps, runs.error(runs.with_steps(method, steps), reference));
      table.rows.push_back({method.name, static_cast<double>(steps), levels.back().second});
    }
    report.claims.push_back(claim_order(std::string(method.name) + ": order in the step", levels,
                                        method.order, method.margin));
    chart.series.push_back({method.name, levels});
  }
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

void measure_tolerances(const bench::Bench& bench, const Runs& runs, const Vec& reference,
                        StudyReport& report) {
  bench::Table table{"tolerances", {"integrator", "tolerance", "error"}, {}};
  bench::Chart chart{
      "Error against the tolerance", "tolerance", "error of c in L2", true, true, {}};
  for (const std::string& integrator : bench.integrators()) {
    statistics::Points levels;
    double largest_ratio = 0;
    for (double tolerance = 1e-2; tolerance > 0.9e-5; tolerance /= 10) {
      const double error = runs.error(runs.with_tolerance(integrator, tolerance), reference);
      levels.emplace_back(tolerance, error);
      largest_ratio = statistics::larger(largest_ratio, error / tolerance);
      table.rows.push_back({integrator, tolerance, error});
    }
    report.claims.push_back(
        claim_at_most(integrator + ": largest error / tolerance", largest_ratio, 10));
    chart.series.push_back({integrator, levels});
  }
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

StudyReport run(const bench::Bench& bench) {
  const Runs runs(bench);
  StudyReport report;
  report.notes = {
      "The solution is c = 1/2 + cos(t) xyz/4 to t = 1, on a sphere with 16 cells. The reference "
      "is rosenbrock with far smaller steps on the same mesh."};
  const Vec reference = runs.with_steps(kMethods[3], bench.quick() ? 640 : 1280);
  bench.progress(0.3);
  measure_orders(bench, runs, reference, report);
  bench.progress(0.7);
  measure_tolerances(bench, runs, reference, report);
  return report;
}

}  // namespace

StudyEntry time_order_study() {
  return {"time-order", "orders of the integrators in the step size, errors against tolerances",
          run};
}

}  // namespace traceraft::studies
