// Noise that neighbouring measurements share: correlation as a function of their distance, and the
// whitening of values that have it.
#pragma once

#include <Eigen/Sparse>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "backends/suitesparse/sparse_cholesky.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::assimilation {

// Wendland's (1995) function (1 − r)⁸ (32 r³ + 25 r² + 8 r + 1) up to r = 1, then 0: a correlation
// in R³, close to a Gaussian whose standard deviation is kWendlandLength.
double wendland(double r);
inline constexpr double kWendlandLength = 0.21182963643408084;  // √(7/156): both have one integral

// Correlation of two values at a distance, which is a sum of Wendland functions of different
// supports; what they lack of 1 is white noise, the nugget. Lengths in units of R, chordal.
struct NoiseCorrelation {
  struct Component {
    double support;
    double share;  // of the variance
  };
  std::vector<Component> components;  // none: white noise
  bool at_bound = false;              // is it as long as it may be, and maybe longer?
  double error = 0;  // relative standard error of the variance that smooth patterns see

  bool white() const { return components.empty(); }
  double share() const;  // of the variance that neighbours share
  double length() const;  // of the Gaussian exp(−d²/2ℓ²) with the same integral over the surface
  double at(double distance) const;  // of two values
  double support() const;            // none is correlated any further away

  friend bool operator==(const NoiseCorrelation& a, const NoiseCorrelation& b);
};

// "white", or "20 % of its variance is shared by neighbours, over 0.05 R".
std::string text_of(const NoiseCorrelation& correlation);

// A Gaussian of that length and share, as far as the sum has it.
NoiseCorrelation gaussian_correlation(double length, double share);

// The correlation matrix R of values at some points, factorised: R = Q Qᵀ.
class NoiseWhitening {
 public:
  // Throws std::runtime_error for correlations that are none.
  NoiseWhitening(const std::vector<Point>& points, const NoiseCorrelation& correlation);

  // Q⁻¹ X and Q Z: X in units of the standard deviation of each value, rows as the points are; Z
  // white, in the order of the factors. For several threads at once.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& X) const;
  Eigen::MatrixXd coloured(const Eigen::MatrixXd& Z) const;
  const Eigen::SparseMatrix<double>& correlations() const { return R_; }

 private:
  Eigen::SparseMatrix<double> R_;
  suitesparse::SparseCholesky factors_;
  mutable std::mutex one_at_a_time_;
};

// The whitening of values at these points; nothing where noise is white.
using WhiteningPtr = std::shared_ptr<const NoiseWhitening>;
WhiteningPtr whitening(const std::vector<Point>& points, const NoiseCorrelation& correlation);

}  // namespace traceraft::assimilation
