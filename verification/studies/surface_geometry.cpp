// Γ_h itself: area, closedness and total curvature; and that nothing depends on how the mesh cuts
// the surface.
#include <Eigen/Eigenvalues>
#include <cmath>

#include "kernel/fem/sparse_view.hpp"
#include "verification/analytic/manufactured.hpp"
#include "verification/bench/bench.hpp"
#include "verification/bench/motion.hpp"
#include "verification/statistics/power_law.hpp"
#include "verification/statistics/sample.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::studies {
namespace {

struct Body {
  const char* surface;
  double area;       // of the default parameters
  double curvature;  // ∫ of the Gaussian curvature, 2π · Euler characteristic
};

// The ellipsoid's by its elliptic integrals.
double ellipsoid_area(double a, double b, double c) {
  const double angle = std::acos(c / a), sine = std::sin(angle);
  const double k = std::sqrt(a * a * (b * b - c * c) / (b * b * (a * a - c * c)));
  return 2 * kPi * c * c + 2 * kPi * a * b / sine *
                               (std::ellint_2(k, angle) * sine * sine +
                                std::ellint_1(k, angle) * std::cos(angle) * std::cos(angle));
}

// Gauss–Bonnet: the angles that are missing to 2π around the points of a closed surface of
// triangles add up to 2πχ.
double angle_defects(const mesh::CutSurface& surface) {
  std::vector<double> missing(surface.points.size(), 2 * kPi);
  for (const auto& corner : surface.triangles)
    for (int v = 0; v < 3; ++v) {
      const Point at = surface.position[corner[v]];
      const Point e = surface.position[corner[(v + 1) % 3]] - at;
      const Point f = surface.position[corner[(v + 2) % 3]] - at;
      missing[corner[v]] -= std::atan2(e.cross(f).norm(), e.dot(f));
    }
  double sum = 0;
  for (const double angle : missing) sum += angle;
  return sum;
}

void measure_bodies(const bench::Bench& bench, StudyReport& report) {
  const std::vector<Body> bodies = {{"sphere", 4 * kPi, 4 * kPi},
                                    {"ellipsoid", ellipsoid_area(1.2, 1, 0.8), 4 * kPi},
                                    {"torus", 4 * kPi * kPi * 0.4, 0}};
  bench::Table table{"area", {"surface", "cells", "area", "error", "total curvature"}, {}};
  bench::Chart chart{"Error of the area", "h", "relative error", true, true, {}};
  for (const Body& body : bodies) {
    statistics::Points levels;
    double worst = 0;
    for (int cells = 16; cells <= (bench.quick() ? 64 : 128); cells *= 2) {
      const bench::SpacePtr space = bench.space(body.surface, cells);
      const double error = std::fabs(space->area / body.area - 1);
      const double curvature = angle_defects(space->surface);
      levels.emplace_back(space->h(), error);
      worst = statistics::larger(worst, std::fabs(curvature - body.curvature));
      table.rows.push_back(
          {body.surface, static_cast<double>(cells), space->area, error, curvature});
    }
    // Integrals are over the surface; what is left is a quadrature of its curved parts.
    report.claims.push_back(claim_between(std::string(body.surface) + ": order of the area",
                                          statistics::observed_order(levels).order, 3.5, 5));
    report.claims.push_back(claim_at_most(
        std::string(body.surface) + ": total curvature against 2 pi chi", worst, 1e-6));
    chart.series.push_back({body.surface, levels});
  }
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

analytic::SurfaceFunction moved(const analytic::SurfaceFunction& base,
                                const bench::Motion& motion) {
  return [=](const Point& x) {
    analytic::SurfacePoint p = base(motion.home(x));
    p.gradient = motion.turn.transpose() * p.gradient;
    return p;
  };
}

// Largest over smallest eigenvalue of D^-½ A D^-½ with the diagonal D of A; infinite if A is not
// positive definite.
double scaled_condition(const fem::SurfaceSpace& space, const fem::CsrMatrix& A) {
  Eigen::MatrixXd dense = fem::as_eigen(space, A);
  const Vec scale = dense.diagonal().cwiseSqrt().cwiseInverse();
  dense = scale.asDiagonal() * dense * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(dense, Eigen::EigenvaluesOnly);
  const double smallest = solver.eigenvalues()[0];
  return smallest > 0 ? solver.eigenvalues()[dense.rows() - 1] / smallest : HUGE_VAL;
}

struct Cut {
  double area, l2, h1, mass_condition, helmholtz_condition;
};

Cut measure_cut(const bench::Bench& bench, std::uint64_t number) {
  constexpr int kCells = 20, kCoarse = 10;
  const geometry::LevelSetPtr ellipsoid = geometry::make_surface("ellipsoid");
  const bench::Motion motion(number, 0.5 * 10 / 3 / kCells);
  const bench::SpacePtr space = bench.space(bench::moved(ellipsoid, motion), kCells, 1);
  const bench::ErrorNorms errors =
      analytic::stationary_error(*space, moved(analytic::surface_function("ellipsoid"), motion));
  const bench::SpacePtr coarse = bench.space(bench::moved(ellipsoid, motion), kCoarse, 1);
  const fem::CsrMatrix stiffness =
      fem::combine(1, coarse->stiffness, coarse->h(), coarse->normal_stiffness);
  return {space->area, errors.l2, errors.h1, scaled_condition(*coarse, coarse->stabilised_mass),
          scaled_condition(*coarse, fem::combine(1, stiffness, 1, coarse->mass))};
}

void measure_cuts(const bench::Bench& bench, StudyReport& report) {
  const int count = bench.quick() ? 25 : 100;
  std::vector<Cut> cuts(static_cast<std::size_t>(count));
  bench.in_parallel(
      count, [&](int k) { cuts[k] = measure_cut(bench, static_cast<std::uint64_t>(k) + 1); });
  bench::Table table{"cuts", {"quantity", "mean", "deviation", "smallest", "largest"}, {}};
  const auto row = [&](const std::string& what, double Cut::*value) {
    std::vector<double> values;
    for (const Cut& cut : cuts) values.push_back(cut.*value);
    const statistics::Sample m = statistics::sample_of(values);
    table.rows.push_back({what, m.mean, m.deviation, m.min, m.max});
    return m;
  };
  const statistics::Sample area = row("area", &Cut::area);
  const statistics::Sample l2 = row("error of the stationary problem in L2", &Cut::l2);
  const statistics::Sample h1 = row("error of the stationary problem in H1", &Cut::h1);
  const statistics::Sample mass = row("condition of M + 0.3 h S, scaled", &Cut::mass_condition);
  const statistics::Sample helmholtz =
      row("condition of K + M + h S, scaled", &Cut::helmholtz_condition);
  report.tables.push_back(table);
  const double exact = ellipsoid_area(1.2, 1, 0.8);
  const std::string of = std::to_string(count) + " cuts: ";
  report.claims.push_back(claim_at_most(
      of + "largest relative error of the area",
      std::max(std::fabs(area.min / exact - 1), std::fabs(area.max / exact - 1)), 1e-4));
  report.claims.push_back(
      claim_at_most(of + "largest error / mean error, in L2", l2.max / l2.mean, 1.25));
  report.claims.push_back(
      claim_at_most(of + "largest error / mean error, in H1", h1.max / h1.mean, 1.25));
  report.claims.push_back(
      claim_at_most(of + "largest condition number of M + 0.3 h S", mass.max, 40));
  report.claims.push_back(claim_at_most(of + "largest / mean condition number of K + M + h S",
                                        helmholtz.max / helmholtz.mean, 2));
}

StudyReport run(const bench::Bench& bench) {
  StudyReport report;
  report.notes = {
      "A cut is an ellipsoid at a random rotation and shift against the mesh. Errors are those on "
      "20 cells. Condition numbers are those on 10 cells, after diagonal scaling. M is the mass "
      "matrix, K the stiffness matrix, S the stabilisation."};
  measure_bodies(bench, report);
  bench.progress(0.5);
  measure_cuts(bench, report);
  return report;
}

}  // namespace

StudyEntry surface_geometry_study() {
  return {"geometry", "area and curvature of the discrete surface, for any position in the mesh",
          run};
}

}  // namespace traceraft::studies
