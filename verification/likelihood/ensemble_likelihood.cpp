#include "verification/likelihood/ensemble_likelihood.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "verification/measure/log_of_product.hpp"

namespace traceraft {
namespace {

using Kind = FreeParameter::Kind;

constexpr std::size_t index(Quantity quantity) {
  return static_cast<std::size_t>(quantity);
}

double square(double x) {
  return x * x;
}

}  // namespace

double FreeParameter::get(const EnsembleFit& fit) const {
  switch (kind) {
    case Kind::unit:
      return fit.ln_unit;
    case Kind::amplitude:
      return fit.amplitude;
    case Kind::vesicle_scatter:
      return std::log(fit.scatter.vesicle[index(quantity)]);
    default:
      return std::log(fit.scatter.look[index(quantity)]);
  }
}

void FreeParameter::set(double value, EnsembleFit& fit) const {
  switch (kind) {
    case Kind::unit:
      fit.ln_unit = value;
      break;
    case Kind::amplitude:
      fit.amplitude = value;
      break;
    case Kind::vesicle_scatter:
      fit.scatter.vesicle[index(quantity)] = std::exp(value);
      break;
    default:
      fit.scatter.look[index(quantity)] = std::exp(value);
  }
}

EnsembleLikelihood::EnsembleLikelihood(const std::vector<ObservedSeries>& blocks,
                                       const EnsembleModel& model, const UnitPrior& unit)
    : model_(model), unit_(unit) {
  for (const ObservedSeries& series : blocks) {
    const Eigen::Index count = series.ln_t.size();
    Eigen::MatrixXd correlation(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      for (Eigen::Index j = 0; j < count; ++j)
        correlation(i, j) =
            model.base->correlation(series.quantity, series.ln_t[i] - series.ln_t[j]);
    blocks_.push_back({&series, std::move(correlation)});
  }
}

EnsembleLikelihood::Normal EnsembleLikelihood::normal(const Block& block,
                                                      const EnsembleFit& at) const {
  const ObservedSeries& series = *block.series;
  const std::size_t q = index(series.quantity);
  const Eigen::Index count = series.values.size();
  Vec residual(count), deviation(count), own(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = series.ln_t[i] - at.ln_unit;
    const double mean = model_.mean(series.quantity, t, at.amplitude);
    const StatedError& stated = series.stated[static_cast<std::size_t>(i)];
    residual[i] = series.values[i] - mean - stated.bias(mean);
    deviation[i] = std::sqrt(model_.base->variance(series.quantity, t));
    own[i] = stated.of_logarithm(mean) + square(at.scatter.look[q]);
  }
  Eigen::MatrixXd covariance =
      (block.correlation.array() * (deviation * deviation.transpose()).array() +
       square(at.scatter.vesicle[q]))
          .matrix();
  covariance.diagonal() += own;
  return {std::move(residual), std::move(covariance)};
}

double EnsembleLikelihood::deviance(const EnsembleFit& at) const {
  double squares = 0;
  LogOfProduct diagonal;
  for (const Block& block : blocks_) {
    const Normal here = normal(block, at);
    const Eigen::LLT<Eigen::MatrixXd> factor(here.covariance);
    squares += factor.matrixL().solve(here.residual).squaredNorm();
    for (Eigen::Index i = 0; i < here.residual.size(); ++i)
      diagonal.multiply(factor.matrixLLT()(i, i));
  }
  return squares + 2 * diagonal.value() + unit_.deviance(at.ln_unit);
}

// The unit and the amplitude by central differences; a scatter changes the covariance alone.
EnsembleLikelihood::Normal EnsembleLikelihood::derivative(const Block& block, const EnsembleFit& at,
                                                          const FreeParameter& parameter) const {
  constexpr double kStep = 1e-4;
  const Eigen::Index count = block.series->values.size();
  const std::size_t q = index(block.series->quantity);
  if (parameter.kind == Kind::vesicle_scatter)
    return {Vec::Zero(count),
            Eigen::MatrixXd::Constant(count, count, 2 * square(at.scatter.vesicle[q]))};
  if (parameter.kind == Kind::look_scatter)
    return {Vec::Zero(count),
            2 * square(at.scatter.look[q]) * Eigen::MatrixXd::Identity(count, count)};
  EnsembleFit below = at, above = at;
  parameter.set(parameter.get(at) - kStep, below);
  parameter.set(parameter.get(at) + kStep, above);
  const Normal a = normal(block, below), b = normal(block, above);
  return {(b.residual - a.residual) / (2 * kStep), (b.covariance - a.covariance) / (2 * kStep)};
}

// With K = L Lᵀ, z = L⁻¹ r and, for each parameter, w = L⁻¹ ∂r and M = L⁻¹ ∂K L⁻ᵀ:
//   ∂(rᵀ K⁻¹ r + ln |K|) = 2 z·w − zᵀ M z + tr M,   E ∂∂' = 2 w·w' + tr(M M')
DevianceExpansion EnsembleLikelihood::expand(const EnsembleFit& at,
                                             const std::vector<FreeParameter>& parameters) const {
  const auto size = static_cast<Eigen::Index>(parameters.size());
  DevianceExpansion result{deviance(at), Vec::Zero(size), Eigen::MatrixXd::Zero(size, size)};
  std::vector<Normal> white(parameters.size());
  std::vector<Eigen::Index> own;
  for (const Block& block : blocks_) {
    const Normal here = normal(block, at);
    const Eigen::LLT<Eigen::MatrixXd> factor(here.covariance);
    const auto L = factor.matrixL();
    const Vec z = L.solve(here.residual);
    own.clear();
    for (Eigen::Index p = 0; p < size; ++p) {
      const FreeParameter& parameter = parameters[static_cast<std::size_t>(p)];
      const bool scatter =
          parameter.kind == Kind::vesicle_scatter || parameter.kind == Kind::look_scatter;
      if (scatter && parameter.quantity != block.series->quantity) continue;
      Normal& w = white[static_cast<std::size_t>(p)];
      w = derivative(block, at, parameter);
      L.solveInPlace(w.residual);
      L.solveInPlace(w.covariance);
      w.covariance = L.solve(w.covariance.transpose()).eval();
      result.gradient[p] += 2 * z.dot(w.residual) - z.dot(w.covariance * z) + w.covariance.trace();
      own.push_back(p);
      for (const Eigen::Index o : own) {
        const Normal& other = white[static_cast<std::size_t>(o)];
        const double product =
            2 * w.residual.dot(other.residual) + w.covariance.cwiseProduct(other.covariance).sum();
        result.hessian(p, o) += product;
        if (o != p) result.hessian(o, p) += product;
      }
    }
  }
  for (Eigen::Index p = 0; p < size; ++p)
    if (parameters[static_cast<std::size_t>(p)].kind == Kind::unit) {
      result.gradient[p] += unit_.slope(at.ln_unit);
      result.hessian(p, p) += 2 / square(unit_.deviation);
    }
  return result;
}

}  // namespace traceraft
