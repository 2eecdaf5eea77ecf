#include "kernel/discs/ripening.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace traceraft::discs {
namespace {

double uncovered(const Vec& area) {
  return 4 * kPi - area.sum();
}

}  // namespace

void Ripening::set_places(const std::vector<Disc>& discs) {
  const auto count = static_cast<Eigen::Index>(discs.size());
  logarithms_.resize(count, count);
  angles_.resize(count, count);
  between_.setZero(3 * count, 3 * count);
  std::vector<TangentFrame> frames;
  for (const Disc& disc : discs) frames.push_back(tangent_frame(disc.centre));
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
      const Point &x = discs[p].centre, &y = discs[q].centre;
      const double chord = (x - y).norm(), w = 0.5 * chord * chord;  // 1 − cos θ
      logarithms_(i, j) = std::log(0.5 * w);
      angles_(i, j) = 2 * std::asin(std::min(1.0, 0.5 * chord));
      const Eigen::RowVector2d x_along_y = x.transpose() * frames[q],
                               y_along_x = y.transpose() * frames[p];
      const Eigen::Index of_i = count + 2 * i, of_j = count + 2 * j;
      between_(i, j) = static_cast<float>(-(logarithms_(i, j) + 1) / (4 * kPi));
      between_.block<2, 1>(of_j, i) = (x_along_y.transpose() / (4 * kPi * w)).cast<float>();
      between_.block<2, 1>(of_i, j) = (y_along_x.transpose() / (4 * kPi * w)).cast<float>();
      between_.block<2, 2>(of_i, of_j) =
          ((frames[p].transpose() * frames[q] / w + y_along_x.transpose() * x_along_y / (w * w)) /
           (4 * kPi))
              .cast<float>();
    }
}

Vec Ripening::half_angles_with_tails(const Vec& area, const Vec& outside) const {
  constexpr double kShare = 0.45;  // of the gap to a neighbour
  Vec angle = area.unaryExpr([](double a) { return half_angle(a); });
  Vec tail = outside.unaryExpr([&](double c) { return phases_.tail(c); });
  for (Eigen::Index i = 0; i < area.size(); ++i) {
    tail[i] = std::min(tail[i], kShare * (kPi - angle[i]));
    for (Eigen::Index j = 0; j < i; ++j) {
      const double room = kShare * std::max(0.0, angles_(i, j) - angle[i] - angle[j]);
      tail[i] = std::min(tail[i], room);
      tail[j] = std::min(tail[j], room);
    }
  }
  return angle + tail;
}

// `own`: the diagonal, of charges without the sum of both caps, which is of rank two.
Vec Ripening::product(const Vec& caps, const Vec& own, const Vec& x) const {
  const auto charges = x.head(caps.size());
  Vec result = own.cwiseProduct(x);
  const Eigen::VectorXf among = between_.selfadjointView<Eigen::Lower>() * x.cast<float>().eval();
  result += among.cast<double>();
  result.head(caps.size()).array() -=
      (charges.sum() * caps.array() + caps.dot(charges)) / (4 * kPi);
  return result;
}

// Conjugate gradients on charges and dipoles, preconditioned by the charges' matrix and the
// dipoles' own terms: the whole matrix is symmetric and positive. Perimeters were as exact with
// five times this tolerance as with a hundredth of that.
bool Ripening::solve_charges(const Vec& angle, const Vec& difference, Vec& charge) const {
  constexpr double kTolerance = 2e-5;
  constexpr int kMostIterations = 200;
  const Eigen::Index count = angle.size();
  // ln((1 + cos α)/2) = 2 ln cos(α/2)
  const Vec caps = angle.unaryExpr([](double a) { return 2 * std::log(std::cos(a / 2)); });
  Eigen::MatrixXd green(count, count);
  Vec own(3 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < i; ++j)
      green(i, j) = -(logarithms_(i, j) + caps[i] + caps[j] + 1) / (4 * kPi);
    green(i, i) = -(2 * std::log(std::sin(angle[i] / 2)) + caps[i] + 1) / (4 * kPi);
    own[i] = green(i, i) + 2 * caps[i] / (4 * kPi);
    const double radius = 2 * std::tan(angle[i] / 2);
    own.segment<2>(count + 2 * i).setConstant(1 / (2 * kPi * radius * radius));
  }
  const Eigen::LLT<Eigen::MatrixXd> factors(green);
  if (factors.info() != Eigen::Success) return false;
  const auto preconditioned = [&](const Vec& r) {
    Vec charges = r.head(count), z(3 * count);
    factors.solveInPlace(charges);
    z << charges, r.tail(2 * count).cwiseQuotient(own.tail(2 * count));
    return z;
  };
  Vec right = Vec::Zero(3 * count);
  right.head(count) = difference;
  const double enough =
      kTolerance * kTolerance * difference.dot(difference.cwiseQuotient(Vec(green.diagonal())));
  if (charges_.size() != 3 * count) charges_ = Vec::Zero(3 * count);
  Vec& x = charges_;
  Vec r = right - product(caps, own, x), z = preconditioned(r), d = z;
  double now = r.dot(z);
  for (int k = 0; k < kMostIterations && now > enough; ++k) {
    const Vec applied = product(caps, own, d);
    const double along = d.dot(applied);
    if (!(along > 0)) return false;
    x += now / along * d;
    r -= now / along * applied;
    z = preconditioned(r);
    const double next = r.dot(z);
    d = z + next / now * d;
    now = next;
  }
  charge = x.head(count);
  return now <= enough;
}

// Close neighbours exchange more than charges and dipoles can tell. Of two discs alone the exact
// conductance is known, 2π/arcosh I with their inversive distance I, and so is that of charges and
// dipoles; the difference is added. Between both on their line, ∇N is sin θ/(4πw) and ∇∇N 1/(4πw),
// w = 1 − cos θ.
void Ripening::add_near_fluxes(const Vec& angle, const Vec& potential, Vec& charge) const {
  const auto own = [&](Eigen::Index i) {
    return -(2 * std::log(std::sin(angle[i]) / 2) + 1) / (4 * kPi);
  };
  const auto caps = [&](Eigen::Index i) { return 2 * std::log(std::cos(angle[i] / 2)); };
  for (Eigen::Index i = 0; i < angle.size(); ++i)
    for (Eigen::Index j = 0; j < i; ++j) {
      const double theta = angles_(i, j), near = theta - angle[i] - angle[j];
      if (!(near > 0 && near < angle[i] + angle[j])) continue;
      const double w = 1 - std::cos(theta), slope = std::sin(theta) / (4 * kPi * w),
                   between = 1 / (4 * kPi * w), a = 2 * std::tan(angle[i] / 2),
                   b = 2 * std::tan(angle[j] / 2), of_i = 1 / (2 * kPi * a * a),
                   of_j = 1 / (2 * kPi * b * b), determinant = of_i * of_j - between * between,
                   p_i = slope * (of_j + between) / determinant,
                   p_j = -slope * (of_i + between) / determinant;
      const double mutual = -(logarithms_(i, j) + caps(i) + caps(j) + 1) / (4 * kPi),
                   resistance = own(i) + own(j) - 2 * mutual + slope * (p_j - p_i),
                   inversive = (std::cos(angle[i]) * std::cos(angle[j]) - std::cos(theta)) /
                               (std::sin(angle[i]) * std::sin(angle[j]));
      const double more = 2 * kPi / std::acosh(inversive) - 1 / resistance;
      const double flux = std::max(more, 0.0) * (potential[j] - potential[i]);
      charge[i] += flux;
      charge[j] -= flux;
    }
}

bool Ripening::rate(const Contents& contents, Contents& result) const {
  const Eigen::Index count = contents.area.size();
  const double outside = uncovered(contents.area);
  if (!(outside > 0) || (count > 0 && !(contents.area.minCoeff() > 0))) return false;
  const double around = background(contents);
  const Vec beside = contents.area.unaryExpr(
      [&](double area) { return phases_.outside(phases_.potential(area)); });
  const Vec angle = half_angles_with_tails(contents.area, beside);
  const Vec potential = beside.unaryExpr([&](double c) { return phases_.flux_potential(c); });
  // The potential inside a disc is that of its boundary.
  const double mean =
      (outside * phases_.flux_potential(around) + contents.area.dot(potential)) / (4 * kPi);
  Vec flux;
  if (!solve_charges(angle, (mean - potential.array()).matrix(), flux)) return false;
  add_near_fluxes(angle, potential, flux);
  result.area.resize(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result.area[i] = flux[i] / (phases_.mass_slope(contents.area[i]) - around);
  result.mass = uptake_ * (4 * kPi - contents.mass);
  return result.area.allFinite();
}

double Ripening::background(const Contents& contents) const {
  double rest = contents.mass;
  for (const double area : contents.area) rest -= phases_.mass(area);
  return rest / uncovered(contents.area);
}

}  // namespace traceraft::discs
