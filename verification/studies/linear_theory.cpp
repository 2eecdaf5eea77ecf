// Growth and decay of small perturbations of a uniform concentration c0 on the unit sphere: the
// spherical harmonic of degree l changes at the rate
//   −M(c0) λ (f0''(c0) + ε² λ),   λ = l (l + 1).
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/core/text.hpp"
#include "kernel/fem/sparse_view.hpp"
#include "verification/bench/bench.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

constexpr double kEpsilon = 0.1;
constexpr double kAmplitude = 1e-6;
constexpr int kHighest = 12;
constexpr const char* kConstant = "constant:value=0.25";

// P_l of the angle to an axis that lies anyhow in the mesh, constant along normals.
Vec harmonic(const fem::SurfaceSpace& space, int degree) {
  const Point axis = Point(1, 2, 3).normalized();
  Vec nodal(space.nodes());
  for (int i = 0; i < space.nodes(); ++i)
    nodal[i] = std::legendre(static_cast<unsigned>(degree),
                             std::clamp(axis.dot(space.mesh.position(i).normalized()), -1.0, 1.0));
  return nodal;
}

// Ritz projections, (K + M + h S) c = (λ + 1) M Y. What interpolation would add to Y has small
// values but rates of up to M ε²/h⁴.
class RitzProjection {
 public:
  explicit RitzProjection(const fem::SurfaceSpace& space) : space_(space) {
    const fem::CsrMatrix stiffness =
        fem::combine(1, space.stiffness, space.h(), space.normal_stiffness);
    factors_.compute(fem::as_eigen(space, fem::combine(1, stiffness, 1, space.mass)));
    if (factors_.info() != Eigen::Success) throw std::runtime_error("no factors of K + M + h S");
  }
  Vec operator()(const Vec& Y, int degree) const {
    Vec load(space_.nodes());
    space_.mass.multiply(Y, load, *space_.team);
    load *= degree * (degree + 1) + 1;
    return factors_.solve(load);
  }

 private:
  const fem::SurfaceSpace& space_;
  Eigen::SimplicialLDLT<fem::EigenMatrix> factors_;
};

double exact_rate(const problem::CahnHilliardModel& model, double c0, int degree) {
  double mobility = 0;
  model.mobility->evaluate(&c0, 1, &mobility, nullptr);
  const double lambda = degree * (degree + 1);
  return -mobility * lambda * (model.well.second(c0) + model.epsilon * model.epsilon * lambda);
}

// A harmonic on a mesh.
struct Mode {
  Vec exact, discrete;  // nodal values of Y, and its projection

  Mode(const fem::SurfaceSpace& space, const RitzProjection& projection, int degree)
      : exact(harmonic(space, degree)), discrete(projection(exact, degree)) {}
};

// (ċ, Y)/(c − c0, Y) of the semi-discrete system: no integrator takes part.
double semidiscrete_rate(const problem::CahnHilliard& problem, double c0, const Mode& mode) {
  const fem::SurfaceSpace& space = problem.space();
  const Vec perturbation = kAmplitude * mode.discrete;
  const bench::StartState state =
      bench::consistent_state(problem, Vec::Constant(space.nodes(), c0) + perturbation);
  return space.inner(problem.c_of(state.ydot), mode.exact) / space.inner(perturbation, mode.exact);
}

// ln of the growth over `span` divided by it, from a run of the bench's integrator.
double integrated_rate(const bench::Bench& bench, const problem::CahnHilliard& problem, double c0,
                       const Mode& mode, double span, int steps) {
  const fem::SurfaceSpace& space = problem.space();
  const Vec perturbation = kAmplitude * mode.discrete;
  const Vec uniform = Vec::Constant(space.nodes(), c0);
  time::IntegratorSettings settings;
  settings.tolerance = 1e-6;  // of c, of which the perturbation is a millionth: the steps are set
  settings.initial_step = settings.max_step = span / steps;
  settings.linear_tolerance = 1e-12;
  const time::IntegratorPtr integrator =
      bench.make_integrator(problem, space, bench.integrator(), bench.linear_solver(), settings);
  bench::advance_to(*integrator, bench::consistent_state(problem, uniform + perturbation), span);
  const Vec end = problem.c_of(integrator->state()) - uniform;
  return std::log(space.inner(end, mode.exact) / space.inner(perturbation, mode.exact)) / span;
}

// Differences are relative to the largest rate at this c0: some rates are nearly zero.
double scale(const problem::CahnHilliardModel& model, double c0) {
  double largest = 0;
  for (int l = 1; l <= kHighest; ++l)
    largest = std::max(largest, std::fabs(exact_rate(model, c0, l)));
  return largest;
}

struct Background {
  std::string mobility;
  double c0;
  statistics::Points errors = {}, found = {}, theory = {};  // found and theory on the finest mesh

  std::string label() const { return mobility + ", c0 = " + formatted("%.2f", c0); }
};

void measure_mesh(const bench::Bench& bench, int cells, std::vector<Background>& backgrounds,
                  bench::Table& table) {
  const bench::SpacePtr space = bench.space("sphere", cells);
  const RitzProjection projection(*space);
  std::vector<double> squares(backgrounds.size(), 0);
  for (Background& at : backgrounds) at.found = at.theory = {};
  for (int degree = 1; degree <= kHighest; ++degree) {
    const Mode mode(*space, projection, degree);
    for (std::size_t k = 0; k < backgrounds.size(); ++k) {
      Background& at = backgrounds[k];
      const problem::CahnHilliardModel model = bench::bench_model(at.mobility, kEpsilon);
      const bench::ProblemPtr problem = bench.problem(space, model);
      const double rate = semidiscrete_rate(*problem, at.c0, mode);
      const double exact = exact_rate(model, at.c0, degree);
      squares[k] += std::pow((rate - exact) / scale(model, at.c0), 2) / kHighest;
      at.found.emplace_back(degree, rate);
      at.theory.emplace_back(degree, exact);
      table.rows.push_back({at.mobility, at.c0, static_cast<double>(degree),
                            static_cast<double>(cells), rate, exact});
    }
  }
  for (std::size_t k = 0; k < backgrounds.size(); ++k)
    backgrounds[k].errors.emplace_back(space->h(), std::sqrt(squares[k]));
}

void measure_rates(const bench::Bench& bench, StudyReport& report) {
  std::vector<Background> backgrounds;
  for (const char* mobility : {kConstant, "degenerate"})
    for (const double c0 : {0.5, 0.35, 0.15}) backgrounds.push_back({mobility, c0});
  bench::Table table{"rates", {"mobility", "c0", "l", "cells", "rate", "theory"}, {}};
  bench::Chart chart{
      "Growth rates of spherical harmonics", "degree l", "rate (D/R^2)", false, false, {}};
  bench::Chart errors{"Error of the rates", "h", "RMS over l, relative", true, true, {}};
  const int finest = bench.quick() ? 128 : 256;
  for (int cells = finest / 4; cells <= finest; cells *= 2) {
    measure_mesh(bench, cells, backgrounds, table);
    bench.progress(0.9 * cells * cells / (finest * finest));
  }
  for (const Background& at : backgrounds) {
    report.claims.push_back(
        claim_order(at.label() + ": order of the rates in h", at.errors, 2, 0.3));
    report.claims.push_back(claim_at_most(at.label() + ": RMS error of l = 1 to 12, relative",
                                          at.errors.back().second, bench.quick() ? 0.02 : 0.005));
    errors.series.push_back({at.label(), at.errors});
    if (at.mobility != kConstant) continue;  // the same but for a factor
    chart.series.push_back({at.label(), at.found, bench::Mark::points});
    chart.series.push_back({"theory", at.theory, bench::Mark::line});
  }
  report.tables.push_back(table);
  report.charts = {chart, errors};
}

void measure_run(const bench::Bench& bench, StudyReport& report) {
  const bench::SpacePtr space = bench.space("sphere", 32);
  const Mode mode(*space, RitzProjection(*space), 3);
  for (const double c0 : {0.5, 0.15}) {
    const bench::ProblemPtr problem = bench.problem(space, bench::bench_model(kConstant, kEpsilon));
    const double rate = semidiscrete_rate(*problem, c0, mode);
    const double integrated = integrated_rate(bench, *problem, c0, mode, 1 / std::fabs(rate), 200);
    report.claims.push_back(
        claim_near(bench.integrator() + ", l = 3, c0 = " + formatted("%.2f", c0) +
                       ": growth rate in a run / rate of the semi-discrete system",
                   integrated / rate, 1, 0.01));
  }
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      "A sphere with the uniform concentration c0 is perturbed by spherical harmonics of degree l, "
      "with epsilon = 0.1 R. Perturbations can grow for 0.211 < c0 < 0.789. Rates are those of the "
      "semi-discrete system (discrete in space, exact in time). Errors are relative to the largest "
      "rate at the same c0. The last claims compare a run of the integrator with the rate on the "
      "same mesh."};
  measure_rates(bench, report);
  measure_run(bench, report);
  return report;
}

}  // namespace

StudyEntry linear_theory_study() {
  return {"linear", "growth and decay of spherical harmonics against linear theory", run};
}

}  // namespace traceraft::studies
