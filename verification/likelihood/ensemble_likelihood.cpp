#include "verification/likelihood/ensemble_likelihood.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "verification/statistics/log_of_product.hpp"

namespace traceraft::likelihood {
namespace {

using Kind = FreeParameter::Kind;

constexpr double kLeastScatter = 0.003, kLargestScatter = 1;

double square(double x) {
  return x * x;
}

double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  statistics::LogOfProduct diagonal;
  for (Eigen::Index i = 0; i < factor.cols(); ++i) diagonal.multiply(factor.matrixLLT()(i, i));
  return 2 * diagonal.value();
}

}  // namespace

double FreeParameter::get(const EnsembleFit& fit) const {
  switch (kind) {
    case Kind::unit:
      return fit.ln_unit;
    case Kind::amplitude:
      return fit.amplitude;
    case Kind::vesicle_scatter:
      return square(fit.scatter.vesicle[observations::index_of(quantity)]);
    default:
      return square(fit.scatter.look[observations::index_of(quantity)]);
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
      fit.scatter.vesicle[observations::index_of(quantity)] = std::sqrt(value);
      break;
    default:
      fit.scatter.look[observations::index_of(quantity)] = std::sqrt(value);
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
            model.base().correlation(series.quantity, series.ln_t[i] - series.ln_t[j]);
    blocks_.push_back({&series, std::move(correlation)});
  }
}

EnsembleLikelihood::Looks EnsembleLikelihood::looks(const Block& block, const EnsembleFit& fit,
                                                    const RunCurves& curves) const {
  const ObservedSeries& series = *block.series;
  const Eigen::Index count = series.values.size();
  const double scatter = square(fit.scatter.look[observations::index_of(series.quantity)]);
  Looks result{Vec(count), Vec(count), Vec(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = series.ln_t[i] - fit.ln_unit;
    const double mean = curves.mean(series.quantity, t);
    const observations::StatedError& stated = series.stated[static_cast<std::size_t>(i)];
    result.residual[i] = series.values[i] - mean - stated.bias(mean);
    result.run[i] = std::sqrt(curves.variance(series.quantity, t));
    result.own[i] = stated.of_logarithm(mean) + scatter;
  }
  return result;
}

EnsembleLikelihood::Looks EnsembleLikelihood::derivative(const Block& block, const Place& at,
                                                         const FreeParameter& parameter) const {
  constexpr double kStep = 1e-4;  // of the mean, for what stated errors make of it
  const bool by_unit = parameter.kind == Kind::unit;
  const RunCurves& by = by_unit                             ? at.curves
                        : parameter.kind == Kind::amplitude ? at.by_amplitude
                                                            : *parameter.derivative;
  const ObservedSeries& series = *block.series;
  const Eigen::Index count = series.values.size();
  Looks result{Vec(count), Vec::Zero(count), Vec(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = series.ln_t[i] - at.fit.ln_unit;
    const double mean = at.curves.mean(series.quantity, t);
    const double change = by_unit ? -by.slope(series.quantity, t) : by.mean(series.quantity, t);
    const observations::StatedError& stated = series.stated[static_cast<std::size_t>(i)];
    const double above = mean + kStep, below = mean - kStep;
    const double bias = (stated.bias(above) - stated.bias(below)) / (2 * kStep);
    result.residual[i] = -(1 + bias) * change;
    result.own[i] =
        (stated.of_logarithm(above) - stated.of_logarithm(below)) / (2 * kStep) * change;
    const double variance = at.curves.variance(series.quantity, t);
    if (parameter.kind == Kind::curve || !(variance > 0)) continue;
    const double more =
        by_unit ? -by.variance_slope(series.quantity, t) : by.variance(series.quantity, t);
    result.run[i] = 0.5 * more / std::sqrt(variance);
  }
  return result;
}

Eigen::MatrixXd EnsembleLikelihood::covariance(const Block& block, const Looks& looks,
                                               const EnsembleFit& at) const {
  Eigen::MatrixXd result = looks.run.asDiagonal() * block.correlation * looks.run.asDiagonal();
  result.array() += square(at.scatter.vesicle[observations::index_of(block.series->quantity)]);
  result.diagonal() += looks.own;
  return result;
}

double EnsembleLikelihood::deviance(const EnsembleFit& at) const {
  double sum = unit_.deviance(at.ln_unit);
  const RunCurves curves = model_.at(at.amplitude);
  for (const Block& block : blocks_) {
    const Looks here = looks(block, at, curves);
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance(block, here, at));
    sum += factor.matrixL().solve(here.residual).squaredNorm() + log_determinant(factor);
  }
  return sum;
}

// Let K be the covariance, α = K⁻¹ r and, for each parameter, B = K⁻¹ ∂K. Then
//   ∂(rᵀ K⁻¹ r + ln |K|) = 2 α·∂r − αᵀ ∂K α + tr B,   E ∂∂' = 2 ∂rᵀ K⁻¹ ∂r' + tr(B B')
void EnsembleLikelihood::add_block(const Block& block, const Place& at,
                                   const std::vector<FreeParameter>& parameters,
                                   DevianceExpansion& sum) const {
  struct Own {
    Eigen::Index parameter;
    Vec residual;           // ∂r
    Vec solved;             // K⁻¹ ∂r
    Eigen::MatrixXd share;  // B
  };
  const observations::Quantity quantity = block.series->quantity;
  const Eigen::Index count = block.series->values.size();
  const Looks here = looks(block, at.fit, at.curves);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance(block, here, at.fit));
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(count, count));
  const Vec alpha = inverse.lazyProduct(here.residual);
  sum.value += alpha.dot(here.residual) + log_determinant(factor);
  std::vector<Own> all;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FreeParameter& parameter = parameters[i];
    const auto p = static_cast<Eigen::Index>(i);
    if (parameter.scatters() && parameter.quantity != quantity) continue;
    Own own{p, Vec::Zero(count), Vec::Zero(count), {}};
    Eigen::MatrixXd change;  // ∂K
    if (parameter.scatters()) {
      if (parameter.kind == Kind::vesicle_scatter)
        change.setOnes(count, count);
      else
        change.setIdentity(count, count);
    } else {
      const Looks by = derivative(block, at, parameter);
      const Eigen::MatrixXd runs = by.run.lazyProduct(here.run.transpose());
      change = block.correlation.cwiseProduct(runs + runs.transpose());
      change.diagonal() += by.own;
      own.residual = by.residual;
      own.solved = inverse.lazyProduct(by.residual);
    }
    own.share = inverse.lazyProduct(change);
    sum.gradient[p] +=
        2 * alpha.dot(own.residual) - alpha.dot(change.lazyProduct(alpha)) + own.share.trace();
    all.push_back(std::move(own));
    for (const Own& other : all) {
      const double product = 2 * all.back().solved.dot(other.residual) +
                             all.back().share.cwiseProduct(other.share.transpose()).sum();
      sum.hessian(p, other.parameter) += product;
      if (other.parameter != p) sum.hessian(other.parameter, p) += product;
    }
  }
}

DevianceExpansion EnsembleLikelihood::expand(const EnsembleFit& at,
                                             const std::vector<FreeParameter>& parameters) const {
  const auto size = static_cast<Eigen::Index>(parameters.size());
  DevianceExpansion result{unit_.deviance(at.ln_unit), Vec::Zero(size),
                           Eigen::MatrixXd::Zero(size, size)};
  const Place place{at, model_.at(at.amplitude), model_.by_amplitude(at.amplitude)};
  for (const Block& block : blocks_) add_block(block, place, parameters, result);
  for (Eigen::Index p = 0; p < size; ++p)
    if (parameters[static_cast<std::size_t>(p)].kind == Kind::unit) {
      result.gradient[p] += unit_.slope(at.ln_unit);
      result.hessian(p, p) += 2 / square(unit_.deviation);
    }
  return result;
}

FreeParameters::FreeParameters(const std::vector<ObservedSeries>& blocks,
                               const EnsembleModel& model, const UnitPrior& unit) {
  std::vector<statistics::Interval> bounds;
  const auto add = [&](const FreeParameter& parameter, double low, double high) {
    all.push_back(parameter);
    bounds.push_back({low, high});
  };
  add({Kind::unit}, unit.lowest(), unit.highest());
  if (model.has_effect())
    add({Kind::amplitude}, model.least_amplitude(), model.largest_amplitude());
  for (const observations::Quantity quantity : observations::kQuantities)
    if (std::any_of(blocks.begin(), blocks.end(),
                    [&](const ObservedSeries& block) { return block.quantity == quantity; }))
      for (const Kind kind : {Kind::vesicle_scatter, Kind::look_scatter})
        add({kind, quantity}, square(kLeastScatter), square(kLargestScatter));
  const auto count = static_cast<Eigen::Index>(all.size());
  lower.resize(count);
  upper.resize(count);
  for (Eigen::Index p = 0; p < count; ++p) {
    lower[p] = bounds[static_cast<std::size_t>(p)].low;
    upper[p] = bounds[static_cast<std::size_t>(p)].high;
  }
}

Vec FreeParameters::get(const EnsembleFit& fit) const {
  Vec values(lower.size());
  for (std::size_t p = 0; p < all.size(); ++p)
    values[static_cast<Eigen::Index>(p)] = all[p].get(fit);
  return values;
}

void FreeParameters::set(const Vec& values, EnsembleFit& fit) const {
  for (std::size_t p = 0; p < all.size(); ++p)
    all[p].set(values[static_cast<Eigen::Index>(p)], fit);
}

}  // namespace traceraft::likelihood
