#include "kernel/flow/friction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/flow/harmonic_forms.hpp"

namespace traceraft::flow {
namespace {

class SphereFriction final : public Friction {
 public:
  SphereFriction(const FluidMembrane& membrane, int degree)
      : degree_(degree),
        friction_(by_degree(degree, [&](int l) { return l < 1 ? 1 : membrane.friction(l); })) {}

  int degree() const override { return degree_; }
  Vec capillary(const Vec& force) const override {
    Vec psi = force.cwiseQuotient(friction_);
    psi.head(harmonic_index(1, 1) + 1).setZero();
    return psi;
  }
  Vec brownian(const Vec& normal) const override {
    Vec psi = normal.cwiseQuotient(friction_.cwiseSqrt());
    psi[0] = 0;
    return psi;
  }
  double power(const Vec& psi) const override {
    return psi.tail(psi.size() - 1).cwiseAbs2().dot(friction_.tail(psi.size() - 1));
  }

 private:
  int degree_;
  Vec friction_;
};

// All harmonics but the constant one, which is no flow.
class SurfaceFriction final : public Friction {
 public:
  SurfaceFriction(const geometry::StarSurface& surface, const FluidMembrane& membrane, int degree)
      : degree_(degree) {
    const HarmonicForms forms = harmonic_forms(surface, degree);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> laplacian(forms.stiffness,
                                                                              forms.mass);
    if (laplacian.info() != Eigen::Success)
      throw InputError("the harmonics of its flow cannot be found: the surface is too rugged");
    const Vec value = laplacian.eigenvalues().cwiseMax(0.0);
    const Eigen::MatrixXd vectors = forms.mass * laplacian.eigenvectors();
    const auto function_of_laplacian = [&](const Vec& f) -> Eigen::MatrixXd {
      return without_constant(vectors * f.asDiagonal() * vectors.transpose());
    };
    const Eigen::MatrixXd of_membrane = function_of_laplacian(value.cwiseAbs2()) -
                                        2 * without_constant(forms.curved_stiffness),
                          of_water = function_of_laplacian(
                              value.array() * (1 / forms.mass(0, 0) + 4 * value.array()).sqrt());
    friction_ = of_membrane + membrane.water * of_water;
    factor_.compute(friction_);
    if (factor_.info() != Eigen::Success)
      throw InputError("the friction of its flow is not positive: the surface is too rugged");
    find_rotations(of_membrane, without_constant(forms.stiffness));
  }

  int degree() const override { return degree_; }
  Vec capillary(const Vec& force) const override {
    const Vec pull = force.tail(force.size() - 1);
    return with_constant(factor_.solve(pull) - rotations_ * (rotations_.transpose() * pull));
  }
  Vec brownian(const Vec& normal) const override {
    return with_constant(factor_.matrixU().solve(normal.tail(normal.size() - 1)));
  }
  double power(const Vec& psi) const override {
    const Vec flow = psi.tail(psi.size() - 1);
    return flow.dot(friction_ * flow);
  }

 private:
  static Eigen::MatrixXd without_constant(const Eigen::MatrixXd& matrix) {
    return matrix.bottomRightCorner(matrix.rows() - 1, matrix.cols() - 1);
  }
  static Vec with_constant(const Vec& flow) {
    Vec psi(flow.size() + 1);
    psi << 0, flow;
    return psi;
  }

  // Flows without friction of the membrane are rotations: the null space of F ψ = λ S ψ with the
  // stiffness S, by subspace iteration from the lowest harmonics. The next λ on a sphere is 4/R².
  // Harmonics up to a degree resolve less of Δψ than there is, so that λ of a rotation is ≤ 0.
  void find_rotations(const Eigen::MatrixXd& of_membrane, const Eigen::MatrixXd& stiffness) {
    constexpr double kShift = 0.1, kNone = 1e-5;  // of λ
    constexpr int kIterations = 12, kColumns = 8, kMostRotations = 3;
    const Eigen::LLT<Eigen::MatrixXd> shifted(of_membrane + kShift * stiffness);
    Eigen::MatrixXd flows = Eigen::MatrixXd::Identity(of_membrane.rows(), kColumns);
    for (int k = 0; k < kIterations; ++k)
      flows =
          Eigen::HouseholderQR<Eigen::MatrixXd>(shifted.solve(stiffness * flows)).householderQ() *
          Eigen::MatrixXd::Identity(flows.rows(), kColumns);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ritz(
        flows.transpose() * of_membrane * flows, flows.transpose() * stiffness * flows);
    const Eigen::Index count = (ritz.eigenvalues().array() < kNone).count();
    if (shifted.info() != Eigen::Success || ritz.info() != Eigen::Success || count > kMostRotations)
      throw InputError("the rotations of its flow cannot be found: the surface is too rugged");
    rotations_ = flows * ritz.eigenvectors().leftCols(count);
    const Eigen::MatrixXd power = rotations_.transpose() * friction_ * rotations_;
    rotations_ = power.llt().matrixL().solve(rotations_.transpose()).transpose().eval();
  }

  int degree_;
  Eigen::MatrixXd friction_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd rotations_;  // columns with rotationsᵀ F rotations = 1
};

}  // namespace

std::shared_ptr<const Friction> make_friction(const geometry::StarSurface& surface,
                                              const FluidMembrane& membrane, int degree) {
  constexpr int kHighestDegree = 32;
  if (surface.is_unit_sphere()) return std::make_shared<SphereFriction>(membrane, degree);
  return std::make_shared<SurfaceFriction>(surface, membrane, std::min(degree, kHighestDegree));
}

}  // namespace traceraft::flow
