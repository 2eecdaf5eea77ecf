#include "verification/selection/fit/refit_unknowns.hpp"

#include <cmath>

namespace traceraft {

Vec unknown_factors(const Hypothesis& hypothesis, double pace) {
  Vec result(1 + hypothesis.coefficients());
  result[0] = 1;
  Eigen::Index next = 1;
  for (const auto& part : hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d)
      result[next++] = part.candidate.rate ? pace : 1;
  return result;
}

Vec unknowns(const FilterModel& model) {
  Vec x = unknown_factors(model.hypothesis, model.pace);
  x[0] = std::log(model.pace);
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (const double a : part.coefficients) x[next++] *= a;
  return x;
}

void set_unknowns(FilterModel& model, const Vec& x) {
  model.pace = std::exp(x[0]);
  const Vec factor = unknown_factors(model.hypothesis, model.pace);
  Eigen::Index next = 1;
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) {
      a = part.candidate.within_range(x[next] / factor[next]);
      ++next;
    }
}

FilterModel at_pace(FilterModel model, double pace) {
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) a *= part.candidate.rate ? model.pace / pace : 1;
  model.pace = pace;
  return model;
}

FilterModel with_strengths(double factor, FilterModel model) {
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) a *= factor;
  return model;
}

Eigen::MatrixXd unknown_derivatives(const FilterModel& model) {
  const Vec x = unknowns(model);
  Eigen::MatrixXd J = unknown_factors(model.hypothesis, model.pace).asDiagonal();
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d, ++next)
      if (part.candidate.rate) J(next, 0) = x[next];
  return J;
}

std::vector<Eigen::Index> own_parameters(const Hypothesis& hypothesis) {
  std::vector<Eigen::Index> own{kPace};
  for (Eigen::Index k = 0; k < hypothesis.coefficients(); ++k) own.push_back(kFirstParameter + k);
  return own;
}

}  // namespace traceraft
