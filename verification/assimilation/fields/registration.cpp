#include "verification/assimilation/fields/registration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "backends/nlopt/minimise.hpp"
#include "kernel/core/random.hpp"
#include "verification/assimilation/fields/field_series.hpp"
#include "verification/assimilation/fields/point_trace.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::assimilation {
namespace {

// Rotations that are tried, about 0.35 rad apart, by so many values each; and the best of them.
constexpr int kTried = 8000, kTriedValues = 300, kMostRefined = 8;
constexpr Eigen::Index kFineValues = 2000;
// Limits of a rotation that is registered: the least correlation with the field before; the largest
// variance that is left, over that without a rotation; and the least angle, in rad.
constexpr double kAlike = 0.7, kClearly = 0.8, kLeastAngle = 0.05;

// Directions of the samples: cell by cell, face by face.
Point cube_direction(int face, double u, double v) {
  const int axis = face / 2;
  Point x;
  x[axis] = face % 2 == 0 ? 1 : -1;
  x[(axis + 1) % 3] = u;
  x[(axis + 2) % 3] = v;
  return x.normalized();
}

// Uniform over all rotations (Shoemake 1992).
Eigen::Matrix3d random_rotation(std::uint64_t index) {
  const auto uniform = [&](std::uint64_t i) {
    return uniform_random(statistics::fixed_seed::registration, 0, 3 * index + i);
  };
  const double u = uniform(0), a = 2 * kPi * uniform(1), b = 2 * kPi * uniform(2);
  const double s = std::sqrt(1 - u), t = std::sqrt(u);
  return Eigen::Quaterniond(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b))
      .toRotationMatrix();
}

Eigen::Matrix3d rotation_by(const Point& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

// The share of the variance that is left.
double left_by(double correlation) {
  return 1 - correlation * std::max(correlation, 0.0);
}

// The measure by which rotations are chosen: the smaller, the better. A field that looks the same
// after some of them, such as a single cap turned about its axis, leaves open which one it was. The
// one with the least angle counts then. Elsewhere the preference is weaker than noise.
double misfit(double correlation, const Eigen::Matrix3d& rotation) {
  constexpr double kPreference = 0.02;
  const double angle = angle_of(rotation);
  return left_by(correlation) * (1 + kPreference * angle * angle);
}

class Alignment {
 public:
  Alignment(const SphereMap& before, const std::vector<Point>& points, const Vec& values)
      : before_(before), points_(points), values_(values) {}

  // Correlation coefficient of every `stride`-th value with the field turned by Q.
  double operator()(const Eigen::Matrix3d& Q, Eigen::Index stride) const {
    const Eigen::Matrix3d back = Q.transpose();
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (Eigen::Index i = 0; i < values_.size(); i += stride) {
      const double f = before_.at(back * points_[static_cast<std::size_t>(i)]), v = values_[i];
      ++n;
      x += f;
      y += v;
      xx += f * f;
      yy += v * v;
      xy += f * v;
    }
    const double spread = (xx - x * x / n) * (yy - y * y / n);
    return spread > 0 ? (xy - x * y / n) / std::sqrt(spread) : 0;
  }

  Eigen::Index stride_for(Eigen::Index values) const {
    return std::max<Eigen::Index>(1, values_.size() / values);
  }

  Eigen::Matrix3d refined(const Eigen::Matrix3d& near) const {
    nlopt::MinimiseRequest request;
    request.function = [&](const std::vector<double>& w) {
      const Eigen::Matrix3d Q = rotation_by({w[0], w[1], w[2]}) * near;
      return misfit((*this)(Q, stride_for(kFineValues)), Q);
    };
    request.start.assign(3, 0);
    request.lower.assign(3, -0.6);
    request.upper.assign(3, 0.6);
    request.step.assign(3, 0.1);
    request.tolerance = 1e-3;
    request.most_evaluations = 120;
    const std::vector<double> w = nlopt::minimise(request).x;
    return rotation_by({w[0], w[1], w[2]}) * near;
  }

 private:
  const SphereMap& before_;
  const std::vector<Point>& points_;
  const Vec& values_;
};

std::vector<Eigen::Matrix3d> most_alike(const Alignment& alignment) {
  std::vector<std::pair<double, int>> all;
  const Eigen::Index stride = alignment.stride_for(kTriedValues);
  for (int k = 0; k < kTried; ++k)
    all.emplace_back(-alignment(random_rotation(static_cast<std::uint64_t>(k)), stride), k);
  std::partial_sort(all.begin(), all.begin() + kMostRefined, all.end());
  std::vector<Eigen::Matrix3d> best{Eigen::Matrix3d::Identity()};
  for (int k = 0; k < kMostRefined; ++k)
    best.push_back(random_rotation(static_cast<std::uint64_t>(all[k].second)));
  return best;
}

}  // namespace

bool is_sphere(const geometry::LevelSet& surface) {
  constexpr std::uint64_t kDirections = 50;
  constexpr double kRound = 1e-9;
  for (std::uint64_t k = 0; k < kDirections; ++k) {
    const Point x =
        uniform_direction(uniform_random(statistics::fixed_seed::registration, 1, 2 * k),
                          uniform_random(statistics::fixed_seed::registration, 1, 2 * k + 1));
    if (std::fabs(surface.value(x)) > kRound) return false;
  }
  return true;
}

double angle_of(const Eigen::Matrix3d& rotation) {
  return Eigen::AngleAxisd(rotation).angle();
}

SphereMap::SphereMap(const fem::SurfaceSpace& space, const Vec& field) {
  std::vector<Point> directions;
  for (int face = 0; face < 6; ++face)
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j)
        directions.push_back(
            cube_direction(face, (2 * i + 1.0) / kSide - 1, (2 * j + 1.0) / kSide - 1));
  samples_ = point_trace(space, directions, kOffSurface) * field;
}

double SphereMap::at(const Point& x) const {
  int axis = 0;
  const double most = x.cwiseAbs().maxCoeff(&axis);
  const int face = 2 * axis + (x[axis] > 0 ? 0 : 1);
  // Places between the middles of cells; at the rim of a face the last ones count.
  const auto place = [&](double u) {
    return std::clamp(0.5 * (u / most + 1) * kSide - 0.5, 0.0, kSide - 1.0);
  };
  const double u = place(x[(axis + 1) % 3]), v = place(x[(axis + 2) % 3]);
  const int i = std::min(static_cast<int>(u), kSide - 2),
            j = std::min(static_cast<int>(v), kSide - 2);
  const double s = u - i, t = v - j;
  const auto sample = [&](int a, int b) {
    return samples_[(face * kSide + i + a) * kSide + j + b];
  };
  return (1 - s) * ((1 - t) * sample(0, 0) + t * sample(0, 1)) +
         s * ((1 - t) * sample(1, 0) + t * sample(1, 1));
}

Eigen::Matrix3d most_alike_rotation(const SphereMap& field, const std::vector<Point>& points,
                                    const Vec& values) {
  const Alignment alignment(field, points, values);
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double least = HUGE_VAL;
  for (const Eigen::Matrix3d& near : most_alike(alignment)) {
    const Eigen::Matrix3d Q = alignment.refined(near);
    const double here = misfit(alignment(Q, 1), Q);
    if (here >= least) continue;
    least = here;
    best = Q;
  }
  return best;
}

Registration register_values(const SphereMap& field, const std::vector<Point>& points,
                             const Vec& values) {
  const Alignment alignment(field, points, values);
  const Eigen::Matrix3d Q = most_alike_rotation(field, points, values);
  const double with = alignment(Q, 1), without = alignment(Eigen::Matrix3d::Identity(), 1);
  if (with < kAlike || left_by(with) > kClearly * left_by(without) || angle_of(Q) < kLeastAngle)
    return {Eigen::Matrix3d::Identity(), false, without};
  return {Q, true, with};
}

}  // namespace traceraft::assimilation
