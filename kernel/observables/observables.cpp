#include "kernel/observables/observables.hpp"

namespace traceraft::observables {

Observer::Observer(const problem::CahnHilliard& problem,
                   std::shared_ptr<const fem::SurfaceSpace> space, double interface_energy)
    : problem_(problem), interface_energy_(interface_energy), finder_(std::move(space)) {}

double Observer::level() const {
  return 0.5 * (problem_.model().well.a + problem_.model().well.b);
}

double Observer::mass_scale() const {
  return problem_.space().area * (problem_.model().well.b - problem_.model().well.a);
}

RaftReport Observer::rafts(VecView y) const {
  return finder_.find(problem_.c_of(y), level());
}

Observables Observer::measure(double t, VecView y, const RaftReport& report) const {
  const fem::SurfaceSpace& space = problem_.space();
  const auto c = problem_.c_of(y);
  const double gradient = problem_.model().epsilon * space.quadratic(space.stiffness, c);
  Observables row;
  row.t = t;
  row.mass = problem_.mass(y);
  row.energy = problem_.energy(y);
  row.perimeter = gradient / interface_energy_;
  row.perimeter_level = report.perimeter;
  row.rafts = static_cast<int>(report.rafts.size());
  row.raft_fraction = report.area / space.area;
  row.domains = row.raft_fraction > 0.5 ? finder_.regions_below(c, level()) : row.rafts;
  row.largest_raft = report.rafts.empty() ? 0 : report.rafts.front().area;
  row.c_min = report.c_min;
  row.c_max = report.c_max;
  return row;
}

}  // namespace traceraft::observables
