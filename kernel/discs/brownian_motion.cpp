#include "kernel/discs/brownian_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "kernel/flow/legendre.hpp"

namespace traceraft::discs {
namespace {

constexpr int kHighestDegree = 160;
// This many waves over the half angle of a disc hardly move it: they would add 0.3 % to its
// variance.
constexpr double kWaves = 6;

int degree_for(const std::vector<Disc>& discs) {
  double smallest = 1;
  for (const Disc& disc : discs) smallest = std::min(smallest, half_angle(disc.area));
  return std::min(kHighestDegree, static_cast<int>(std::ceil(kWaves / smallest)));
}

// √(2Θ (2l + 1)/(4π friction)) of all degrees.
Vec sizes_of_waves(const flow::FluidMembrane& membrane, int degree) {
  Vec size = Vec::Zero(degree + 1);
  for (int l = 1; l <= degree; ++l)
    size[l] = std::sqrt(2 * membrane.thermal * (2 * l + 1) / (4 * kPi * membrane.friction(l)));
  return size;
}

// The same, times F_l(α) of a disc.
Vec weights_of(const Disc& disc, const Vec& sizes) {
  const int degree = static_cast<int>(sizes.size()) - 1;
  return flow::means_over_cap(cosine_of_half_angle(disc.area), degree).cwiseProduct(sizes);
}

// The normal of the great circle through both; where they face each other, `any` is one.
Point common_normal(const Point& x, const Point& y, const Point& any) {
  const Point normal = x.cross(y);
  return normal.norm() > 1e-12 ? Point(normal.normalized()) : any;
}

}  // namespace

void BrownianMotion::set_discs(const std::vector<Disc>& discs) {
  discs_ = discs;
  const auto count = static_cast<Eigen::Index>(discs.size());
  const int degree = degree_for(discs);
  along_.resize(count, count);
  across_.resize(count, count);
  Eigen::ArrayXXd weight(count, degree + 1);
  const Vec sizes = sizes_of_waves(membrane_, degree);
  for (Eigen::Index i = 0; i < count; ++i)
    weight.row(i) = weights_of(discs[static_cast<std::size_t>(i)], sizes).transpose();
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index last = i + 1;  // pairs (i, j) with j ≤ i
    Eigen::ArrayXd x(last), value = Eigen::ArrayXd::Ones(last), before = Eigen::ArrayXd::Zero(last),
                            slope = before, along = before, across = before;
    for (Eigen::Index j = 0; j < i; ++j)
      x[j] =
          discs[static_cast<std::size_t>(i)].centre.dot(discs[static_cast<std::size_t>(j)].centre);
    x[i] = 1;
    for (int l = 1; l <= degree; ++l) {
      // One pass over all arrays: they are short, and memory is what this waits for.
      const double own = weight(i, l), ahead = (2.0 * l - 1) / l, back = (l - 1.0) / l;
      const double* others = weight.col(l).data();
      for (Eigen::Index j = 0; j < last; ++j) {
        const double here = value[j], next = ahead * x[j] * here - back * before[j],
                     both = own * others[j];
        slope[j] = l * here + x[j] * slope[j];
        before[j] = here;
        value[j] = next;
        along[j] += both * slope[j];
        across[j] += both * (l * (l + 1.0) * next - x[j] * slope[j]);
      }
    }
    along_.row(i).head(last) = along.matrix().transpose();
    across_.row(i).head(last) = across.matrix().transpose();
  }
  along_ = Eigen::MatrixXd(along_.selfadjointView<Eigen::Lower>());
  across_ = Eigen::MatrixXd(across_.selfadjointView<Eigen::Lower>());
}

// P_l'(1) = l (l + 1)/2. The smallest disc moves fastest; all others leave room for it, so that no
// rest around them is smaller.
double BrownianMotion::largest_variance(const std::vector<Disc>& discs) const {
  const Disc& smallest = *std::min_element(
      discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.area < b.area; });
  const Vec weight = weights_of(smallest, sizes_of_waves(membrane_, degree_for(discs)));
  double variance = 0;
  for (Eigen::Index l = 1; l < weight.size(); ++l)
    variance += weight[l] * weight[l] * (static_cast<double>(l * (l + 1)) / 2);
  return variance;
}

double BrownianMotion::variance_of_distance(std::size_t i, std::size_t j) const {
  const auto p = static_cast<Eigen::Index>(i), q = static_cast<Eigen::Index>(j);
  return along_(p, p) + along_(q, q) - 2 * along_(p, q);
}

std::vector<Point> BrownianMotion::displacements(double step, const Vec& normal) const {
  const auto count = static_cast<Eigen::Index>(discs_.size());
  std::vector<TangentFrame> frames;
  for (const Disc& disc : discs_) frames.push_back(tangent_frame(disc.centre));
  Eigen::MatrixXd covariance(2 * count, 2 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    covariance.block<2, 2>(2 * i, 2 * i) = along_(i, i) * Eigen::Matrix2d::Identity();
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
      const Point &x = discs_[p].centre, &y = discs_[q].centre;
      const Point normal_of_both = common_normal(x, y, frames[p].col(0));
      const Eigen::Vector2d along_x = frames[p].transpose() * normal_of_both.cross(x),
                            along_y = frames[q].transpose() * normal_of_both.cross(y),
                            across_x = frames[p].transpose() * normal_of_both,
                            across_y = frames[q].transpose() * normal_of_both;
      covariance.block<2, 2>(2 * i, 2 * j) = along_(i, j) * along_x * along_y.transpose() +
                                             across_(i, j) * across_x * across_y.transpose();
    }
  }
  // Rounding may take discs that move as one below zero.
  covariance.diagonal() *= 1 + 1e-10;
  const Eigen::LLT<Eigen::MatrixXd> factors(covariance);
  if (factors.info() != Eigen::Success) return {};
  const Vec moved = factors.matrixL() * Vec(std::sqrt(step) * normal);
  std::vector<Point> result;
  for (Eigen::Index i = 0; i < count; ++i)
    result.emplace_back(frames[static_cast<std::size_t>(i)] * moved.segment<2>(2 * i));
  return result;
}

}  // namespace traceraft::discs
