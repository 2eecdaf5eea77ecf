#include "verification/assimilation/filter/correlation_fit.hpp"

#include <algorithm>
#include <cmath>

#include "verification/assimilation/filter/variance_components.hpp"

namespace traceraft::assimilation {
namespace {

// Supports are in this ratio, and the shortest is so many spacings long.
constexpr double kRatio = 1.4142135623730951, kShortest = 1.2;
// Components of less than that many standard errors are none.
constexpr double kSeenComponent = 2;
// The nugget is that share of the noise at least: noise that is smooth without end has none, and
// its matrices no inverse.
constexpr double kLeastNugget = 0.01;
// Share of the longest component in the integral of the correlation beyond which it may be longer.
constexpr double kMostly = 0.5;

std::vector<double> supports(double spacing) {
  std::vector<double> all{kLongestCorrelation / kWendlandLength};
  while (all.back() / kRatio >= kShortest * spacing) all.push_back(all.back() / kRatio);
  return all;
}

std::vector<CorrelationFunction> functions(const std::vector<double>& supports) {
  std::vector<CorrelationFunction> all{[](double) { return 0.0; }};  // the nugget
  for (const double support : supports)
    all.emplace_back([support](double d) { return (1 - kLeastNugget) * wendland(d / support); });
  return all;
}

// The fit without the components that are not seen. The least certain one is left out first.
VarianceFit without_unseen(const VarianceComponents& model, VarianceFit fit,
                           std::vector<bool> free) {
  for (;;) {
    std::size_t least = 0;
    double certainty = kSeenComponent;
    for (std::size_t k = 1; k < free.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      if (!free[k] || fit.variances[i] == 0) continue;
      const double error = fit.standard_error(i);
      if (fit.variances[i] >= certainty * error) continue;
      certainty = fit.variances[i] / error;
      least = k;
    }
    if (least == 0) return fit;
    free[least] = false;
    Vec start = fit.variances;
    start[0] += start[static_cast<Eigen::Index>(least)];
    start[static_cast<Eigen::Index>(least)] = 0;
    fit = model.fit(start, free);
  }
}

// Smooth patterns see the integral of the covariance over the surface, per value.
double error_over_smooth(const VarianceFit& fit, const std::vector<double>& supports,
                         double spacing) {
  Vec weight = Vec::Ones(fit.variances.size());
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const double length = kWendlandLength * supports[k] / spacing;
    weight[static_cast<Eigen::Index>(k + 1)] = kLeastNugget + 2 * kPi * length * length;
  }
  return std::sqrt(std::max(0.0, weight.dot(fit.covariance * weight))) / weight.dot(fit.variances);
}

NoiseCorrelation correlation_of(const Vec& variances, const std::vector<double>& supports) {
  const double nugget = variances[0] / variances.sum();
  const double scale = nugget < kLeastNugget ? (1 - kLeastNugget) / (1 - nugget) : 1;
  NoiseCorrelation result;
  double integral = 0, longest = 0;
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const double variance = variances[static_cast<Eigen::Index>(k + 1)];
    if (variance == 0) continue;
    result.components.push_back({supports[k], scale * variance / variances.sum()});
    const double part = variance * supports[k] * supports[k];
    integral += part;
    if (k == 0) longest = part;
  }
  result.at_bound = integral > 0 && longest > kMostly * integral;
  return result;
}

}  // namespace

CorrelationFit fit_correlation(const std::vector<NoiseBlock>& blocks, double spacing,
                               const ThreadTeam& team) {
  const std::vector<double> lengths = supports(spacing);
  const VarianceComponents model(blocks, team, functions(lengths));
  const auto count = static_cast<Eigen::Index>(lengths.size() + 1);
  std::vector<bool> all(lengths.size() + 1, true), nugget(lengths.size() + 1, false);
  nugget[0] = true;
  const VarianceFit white = model.fit(Vec::Unit(count, 0), nugget);
  CorrelationFit result;
  result.variance = white.variances[0];
  result.gain = model.score_gain(white.variances, all);
  if (result.gain < kCorrelated) return result;
  const VarianceFit fit = without_unseen(model, model.fit(white.variances, all), all);
  result.correlation = correlation_of(fit.variances, lengths);
  if (!result.correlation.white())
    result.correlation.error = error_over_smooth(fit, lengths, spacing);
  result.variance = fit.variances.sum();
  return result;
}

double fit_variance(const std::vector<NoiseBlock>& blocks, const NoiseCorrelation& correlation,
                    const ThreadTeam& team) {
  const VarianceComponents model(blocks, team, {[&](double d) { return correlation.at(d); }});
  return model.fit(Vec::Ones(1), {true}).variances[0];
}

}  // namespace traceraft::assimilation
