#include "kernel/observables/resolved_boundary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace traceraft::observables {
namespace {

struct Row {
  double h;  // over the width of the boundary, ε for the default well
  double averaged, consistent, nodal;

  double of(fem::PotentialRule rule) const {
    switch (rule) {
      case fem::PotentialRule::averaged:
        return averaged;
      case fem::PotentialRule::consistent:
        return consistent;
      case fem::PotentialRule::nodal:
        return nodal;
    }
    throw std::logic_error("a potential without a table of boundaries");
  }
};

// Two halves of a sphere, 88 cells, 30 axes; (1 − 4 ε²) divided out.
constexpr std::array<Row, 12> kTable = {{{0, 1, 1, 1},
                                         {0.7, 0.9999, 0.9982, 0.9898},
                                         {1, 0.9997, 0.9965, 0.9802},
                                         {1.5, 0.9991, 0.9923, 0.9588},
                                         {2, 0.9983, 0.9869, 0.9333},
                                         {2.5, 0.9978, 0.9817, 0.9094},
                                         {3, 0.9977, 0.9763, 0.8848},
                                         {3.5, 0.9984, 0.9713, 0.8635},
                                         {4, 0.9997, 0.9661, 0.8451},
                                         {5, 1.0031, 0.9532, 0.8181},
                                         {6, 1.0073, 0.9370, 0.7996},
                                         {8, 1.0196, 0.8961, 0.7586}}};

// Linear between rows; the last row beyond.
double resolved_at(fem::PotentialRule rule, double h) {
  const auto above =
      std::find_if(kTable.begin() + 1, kTable.end() - 1, [&](const Row& row) { return h < row.h; });
  const Row &low = *(above - 1), &high = *above;
  const double share = std::min(1.0, (h - low.h) / (high.h - low.h));
  return (1 - share) * low.of(rule) + share * high.of(rule);
}

}  // namespace

ResolvedBoundary resolved_boundary(const problem::CahnHilliardModel& model, double h) {
  const double resolved = resolved_at(model.rule, h / model.boundary_width());
  return {resolved * model.well.interface_energy(), resolved};
}

}  // namespace traceraft::observables
