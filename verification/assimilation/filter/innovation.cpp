#include "verification/assimilation/filter/innovation.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "backends/openblas/dense_algebra.hpp"

namespace traceraft::assimilation {

namespace {

using Factors = Eigen::LLT<Eigen::MatrixXd>;

double log_determinant_of(const Factors& factors) {
  return 2 * factors.matrixLLT().diagonal().array().log().sum();
}

Vec scale_of(const Innovation& innovation, double gap_size) {
  Vec scale = Vec::Constant(innovation.directions.cols(), gap_size);
  scale.head(innovation.state_directions).setOnes();
  return scale;
}

Factors factors_of(const Innovation& innovation, const Vec& scale) {
  return Factors(Eigen::MatrixXd::Identity(scale.size(), scale.size()) +
                 scale.asDiagonal() * innovation.gram * scale.asDiagonal());
}

}  // namespace

InnovationCovariance::InnovationCovariance(const Innovation& innovation, double gap_size)
    : G_(innovation.directions),
      scale_(scale_of(innovation, gap_size)),
      factors_(factors_of(innovation, scale_)) {}

Columns InnovationCovariance::solve(const Columns& X) const {
  return X - openblas::product(G_, amplitudes(X));
}

double InnovationCovariance::log_determinant() const {
  return log_determinant_of(factors_);
}

Columns InnovationCovariance::amplitudes(const Columns& X) const {
  const Columns load = scale_.asDiagonal() * openblas::transposed_product(G_, X);
  return scale_.asDiagonal() * factors_.solve(load);
}

Columns InnovationCovariance::posterior_root(const Columns& L) const {
  return openblas::divided_by_upper(L * scale_.asDiagonal(), factors_.matrixU());
}

Columns at_points(const Innovation& in, const Columns& X) {
  return in.whitening ? in.whitening->coloured(X) : X;
}

Columns whitened(const Innovation& in, const Columns& X) {
  return in.whitening ? in.whitening->whitened(X) : X;
}

Columns gaps_of_replicates(const Innovation& in) {
  if (in.first_frame == 0) return at_points(in, in.replicates);
  const Columns found = InnovationCovariance(in, in.model_error).amplitudes(in.replicates);
  return at_points(
      in, in.replicates - in.directions.leftCols(in.first_frame) * found.topRows(in.first_frame));
}

double most_probable_error(const Innovation& innovation) {
  const Vec load = innovation.directions.transpose() * innovation.values;
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (const double size : {0.0, 0.0025, 0.005, 0.01, 0.02, 0.03, 0.045, 0.07, 0.1, 0.15, 0.25}) {
    const Vec scale = scale_of(innovation, size);
    const Factors factors = factors_of(innovation, scale);
    const Vec scaled = scale.cwiseProduct(load);
    const double deviance = log_determinant_of(factors) - scaled.dot(factors.solve(scaled));
    if (deviance < least) {
      least = deviance;
      best = size;
    }
  }
  return best;
}

Columns explained_parts(const Innovation& innovation, double size, const Columns& values) {
  const Columns patterns = size * innovation.directions.rightCols(innovation.directions.cols() -
                                                                  innovation.state_directions);
  const Columns weighted = InnovationCovariance(innovation, 0).solve(patterns);
  const Factors factors(Eigen::MatrixXd::Identity(patterns.cols(), patterns.cols()) +
                        patterns.transpose() * weighted);
  return factors.matrixL().solve(openblas::transposed_product(weighted, values));
}

double root_mean_square(const std::vector<Innovation>& innovations, bool held_out,
                        const std::function<double(const Innovation&)>& squares) {
  double sum = 0, count = 0;
  for (const Innovation& in : innovations) {
    if (in.held_out != held_out) continue;
    sum += squares(in);
    count += static_cast<double>(in.values.size());
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

Columns side_by_side(const Columns& a, const Columns& b) {
  Columns both(a.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

}  // namespace traceraft::assimilation
