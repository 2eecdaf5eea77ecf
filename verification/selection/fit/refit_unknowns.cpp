#include "verification/selection/fit/refit_unknowns.hpp"

#include <cmath>

namespace traceraft::selection {

Vec unknown_factors(const assimilation::Hypothesis& hypothesis, double diffusion_ratio) {
  Vec result(1 + hypothesis.coefficients());
  result[0] = 1;
  Eigen::Index next = 1;
  for (const auto& part : hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d)
      result[next++] = part.candidate.rate ? diffusion_ratio : 1;
  return result;
}

Vec unknowns(const assimilation::FilterModel& model) {
  Vec x = unknown_factors(model.hypothesis, model.diffusion_ratio);
  x[0] = std::log(model.diffusion_ratio);
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (const double a : part.coefficients) x[next++] *= a;
  return x;
}

void set_unknowns(assimilation::FilterModel& model, const Vec& x) {
  model.diffusion_ratio = std::exp(x[0]);
  const Vec factor = unknown_factors(model.hypothesis, model.diffusion_ratio);
  Eigen::Index next = 1;
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) {
      a = part.candidate.within_range(x[next] / factor[next]);
      ++next;
    }
}

assimilation::FilterModel at_diffusion_ratio(assimilation::FilterModel model,
                                             double diffusion_ratio) {
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients)
      a *= part.candidate.rate ? model.diffusion_ratio / diffusion_ratio : 1;
  model.diffusion_ratio = diffusion_ratio;
  return model;
}

assimilation::FilterModel with_strengths(double factor, assimilation::FilterModel model) {
  for (auto& part : model.hypothesis.parts)
    for (double& a : part.coefficients) a *= factor;
  return model;
}

Eigen::MatrixXd unknown_derivatives(const assimilation::FilterModel& model) {
  const Vec x = unknowns(model);
  Eigen::MatrixXd J = unknown_factors(model.hypothesis, model.diffusion_ratio).asDiagonal();
  Eigen::Index next = 1;
  for (const auto& part : model.hypothesis.parts)
    for (int d = 0; d < part.candidate.directions; ++d, ++next)
      if (part.candidate.rate) J(next, 0) = x[next];
  return J;
}

std::vector<Eigen::Index> own_parameters(const assimilation::Hypothesis& hypothesis) {
  std::vector<Eigen::Index> own{assimilation::kDiffusionRatio};
  for (Eigen::Index k = 0; k < hypothesis.coefficients(); ++k)
    own.push_back(assimilation::kFirstParameter + k);
  return own;
}

}  // namespace traceraft::selection
