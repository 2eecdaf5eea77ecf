#include "verification/assimilation/fields/field_estimate.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "backends/nlopt/minimise.hpp"
#include "backends/openblas/dense_algebra.hpp"
#include "backends/suitesparse/sparse_cholesky.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/fields/gaussian_field.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// −2 ln of the marginal likelihood as a function of the prior; everything scaled by the noise.
class FieldRegression {
 public:
  FieldRegression(const fem::SurfaceSpace& space, const NoisyValues& measured)
      : matrices_(space), count_(measured.values.size()) {
    const Vec weight = measured.deviation.cwiseAbs2().cwiseInverse();
    mean_ = measured.values.dot(weight) / weight.sum();
    const Vec centred = measured.values.array() - mean_;
    information_ =
        fem::EigenMatrix(measured.trace.transpose() * weight.asDiagonal() * measured.trace);
    load_ = measured.trace.transpose() * weight.cwiseProduct(centred);
    squares_ = centred.dot(weight.cwiseProduct(centred));
    log_weights_ = weight.array().log().sum();
    inverse_diagonal_ = matrices_.mass.diagonal().cwiseInverse();
    mass_factors_.factorise(matrices_.mass);
  }

  // Factors of the precision of the field given the values.
  void compute(const FieldPrior& prior) {
    const fem::EigenMatrix B = operator_of(prior);
    factors_.factorise(prior.smoothing * fem::EigenMatrix(B * inverse_diagonal_.asDiagonal() * B) +
                       information_);
    field_ = factors_.solve(load_);
  }
  double noise() const {
    return std::sqrt(std::max(squares_ - load_.dot(field_), 1e-300) / static_cast<double>(count_));
  }
  double deviance(const FieldPrior& prior) {
    compute(prior);
    prior_factors_.factorise(operator_of(prior));
    const double log_prior = 2 * prior_factors_.log_determinant() +
                             inverse_diagonal_.array().log().sum() +
                             static_cast<double>(field_.size()) * std::log(prior.smoothing);
    return 2 * static_cast<double>(count_) * std::log(noise()) + factors_.log_determinant() -
           log_prior - log_weights_;
  }

  Vec field() const { return field_.array() + mean_; }

  // M̃ Y = M X, as initial data of a run: off the surface nothing is known.
  Eigen::MatrixXd projected(const Eigen::MatrixXd& X) const {
    return mass_factors_.solve(matrices_.trace_mass * X);
  }

  Eigen::MatrixXd errors(double length, int rank) const {
    return important_directions(
        matrices_, [&](const Eigen::MatrixXd& X) { return factors_.solve(X); }, length, rank);
  }

  Eigen::MatrixXd draws(int count, std::uint64_t stream) const {
    Eigen::MatrixXd z(field_.size(), count);
    for (Eigen::Index i = 0; i < z.size(); ++i)
      z.data()[i] = normal_random(statistics::fixed_seed::field_errors, stream,
                                  static_cast<std::uint64_t>(i));
    return factors_.correlated(z);
  }

 private:
  fem::EigenMatrix operator_of(const FieldPrior& prior) const {
    return matrices_.mass / (prior.length * prior.length) + matrices_.stiffness;
  }

  FieldMatrices matrices_;
  fem::EigenMatrix information_;
  Eigen::Index count_;
  double mean_, squares_, log_weights_;
  Vec load_, inverse_diagonal_, field_;
  suitesparse::SparseCholesky mass_factors_, prior_factors_, factors_;
};

FieldEstimate result_of(FieldRegression& regression, const FieldPrior& prior,
                        const ErrorRequest& wanted) {
  regression.compute(prior);
  FieldEstimate result{regression.projected(regression.field()), prior, regression.noise(), {}, {}};
  if (wanted.rank > 0)
    result.errors =
        regression.projected(result.noise * regression.errors(wanted.length, wanted.rank));
  if (wanted.draws > 0)
    result.draws =
        regression.projected(result.noise * regression.draws(wanted.draws, wanted.stream));
  return result;
}

}  // namespace

FieldEstimate estimate_field(const fem::SurfaceSpace& space, const NoisyValues& measured,
                             const ErrorRequest& wanted) {
  FieldRegression regression(space, measured);
  const double density = static_cast<double>(measured.values.size()) / space.area;
  nlopt::MinimiseRequest request;
  // Logarithms of the length and of the smoothing.
  request.function = [&](const std::vector<double>& x) {
    return regression.deviance({std::exp(x[0]), std::exp(x[1])});
  };
  const double length = 2 * space.h();
  const double smoothing = density * std::pow(length, 4) * 1e-2;
  request.start = {std::log(length), std::log(smoothing)};
  request.lower = {std::log(length / 8), std::log(smoothing) - 14};
  request.upper = {std::log(length * 16), std::log(smoothing) + 14};
  request.step = {0.7, 2};
  request.tolerance = 5e-3;
  request.most_evaluations = 60;
  const nlopt::Minimum best = nlopt::minimise(request);
  return result_of(regression, {std::exp(best.x[0]), std::exp(best.x[1])}, wanted);
}

FieldEstimate estimate_field(const fem::SurfaceSpace& space, const NoisyValues& measured,
                             const FieldPrior& prior, const ErrorRequest& wanted) {
  FieldRegression regression(space, measured);
  return result_of(regression, prior, wanted);
}

void compress(const Eigen::SparseMatrix<double>& A, Eigen::MatrixXd& X, int most) {
  const openblas::SymmetricEigen eigen =
      openblas::symmetric_eigen(openblas::transposed_product(X, A * X));
  const Eigen::Index columns = X.cols();
  const double largest = columns ? eigen.values[columns - 1] : 0;
  Eigen::Index kept = 0;
  while (kept < std::min<Eigen::Index>(most, columns) &&
         eigen.values[columns - 1 - kept] > 1e-10 * largest)
    ++kept;
  X = openblas::product(X, eigen.vectors.rightCols(kept));
}

}  // namespace traceraft::assimilation
