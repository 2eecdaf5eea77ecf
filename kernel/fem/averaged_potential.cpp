#include "kernel/fem/averaged_potential.hpp"

#include <array>
#include <cmath>

namespace traceraft::fem::averaged_potential {
namespace {

using Nodes = Eigen::Vector4d;  // a number per node of a tetrahedron

Nodes values_at(const CutElement& element, VecView field) {
  return {field[element.node[0]], field[element.node[1]], field[element.node[2]],
          field[element.node[3]]};
}

// E_T and its derivatives by the nodal values of c.
class ElementEnergy {
 public:
  ElementEnergy(const SurfaceSpace& space, std::size_t e, const physics::DoubleWell& well,
                VecView c)
      : area_(space.elements[e].area),
        mass_(space.moments[e].mass),
        p_(space.moments[e].mean.data()),
        root_(std::sqrt(2 * well.rho)) {
    const double size = space.mesh.shapes[space.elements[e].shape].size;
    const double larger = 1 - 1 / (size * size);
    xi_ = kVarianceInMean + larger * (1 - kVarianceInMean);
    eta_ = kSlopeTimesVariance + larger * (-1 - kSlopeTimesVariance);
    const Nodes value = values_at(space.elements[e], c);
    const Nodes product = mass_product(value);
    const double mean = p_.dot(value);
    variance_ = value.dot(product) - mean * mean;
    z_ = product - mean * p_;
    slope_ = root_ * (well.a + well.b - 2 * mean);
    w_ = root_ * ((mean - well.a) * (well.b - mean) - xi_ * variance_);
  }

  double value() const { return 0.5 * area_ * (w_ * w_ - eta_ * slope_ * slope_ * variance_); }

  Nodes gradient() const {
    return area_ * ((w_ * slope_ + 2 * eta_ * root_ * slope_ * variance_) * p_ -
                    (2 * xi_ * root_ * w_ + eta_ * slope_ * slope_) * z_);
  }

  // ∂²E_T = α m + β p pᵀ + γ (p zᵀ + z pᵀ) + δ z zᵀ along a direction,
  Nodes second(const Nodes& v) const {
    const Second s = coefficients();
    const double pv = p_.dot(v), zv = z_.dot(v);
    return s.m * mass_product(v) + (s.pp * pv + s.pz * zv) * p_ + (s.pz * pv + s.zz * zv) * z_;
  }
  // and as a matrix.
  Eigen::Matrix4d second() const {
    const Second s = coefficients();
    Eigen::Matrix4d result;
    const auto entry = [&](int i, int j) {
      return s.pp * p_[i] * p_[j] + s.pz * (p_[i] * z_[j] + z_[i] * p_[j]) + s.zz * z_[i] * z_[j];
    };
    for (int i = 0; i < 4; ++i) result(i, i) = s.m * mass_[i] + entry(i, i);
    for (int e = 0; e < 6; ++e) {
      const auto& [i, j] = mesh::kTetEdges[e];
      result(i, j) = result(j, i) = s.m * mass_[4 + e] + entry(i, j);
    }
    return result;
  }

 private:
  struct Second {
    double m, pp, pz, zz;  // α, β, γ, δ
  };

  Second coefficients() const {
    const double slope2 = slope_ * slope_, rw = 2 * root_ * w_, r2 = 4 * root_ * root_;
    return {area_ * (-xi_ * rw - eta_ * slope2),
            area_ * ((1 + eta_) * slope2 + (xi_ - 1) * rw - eta_ * r2 * variance_),
            area_ * (2 * (2 * eta_ - xi_) * root_ * slope_), area_ * (r2 * xi_ * xi_)};
  }

  Nodes mass_product(const Nodes& v) const {
    Nodes product(mass_[0] * v[0], mass_[1] * v[1], mass_[2] * v[2], mass_[3] * v[3]);
    for (int e = 0; e < 6; ++e) {
      const auto& [i, j] = mesh::kTetEdges[e];
      product[i] += mass_[4 + e] * v[j];
      product[j] += mass_[4 + e] * v[i];
    }
    return product;
  }

  double area_;
  const std::array<double, 10>& mass_;
  Eigen::Map<const Nodes> p_;  // ∂c̄/∂c
  Nodes z_;                    // ½ ∂V/∂c
  double root_;                // −w''/2
  double xi_, eta_;
  double variance_, slope_, w_;  // V, w'(c̄), w̄
};

// r += factor · local(element number), four loads at the nodes; each row is summed by one thread in
// the order of elements.
template <class Local>
void add_element_loads(const SurfaceSpace& space, double factor, const Local& local, VecRef r) {
  space.team->run([&](int part) {
    const RowBlock& block = space.blocks[part];
    for (int e = block.touching_elements.begin; e < block.touching_elements.end; ++e) {
      const std::array<int, 4>& node = space.elements[e].node;
      const Nodes load = local(static_cast<std::size_t>(e));
      for (int i = 0; i < 4; ++i)
        if (block.rows.contains(node[i])) r[node[i]] += factor * load[i];
    }
  });
}

}  // namespace

void add(const SurfaceSpace& space, const physics::DoubleWell& well, double factor, VecView c,
         VecRef r) {
  add_element_loads(
      space, factor, [&](std::size_t e) { return ElementEnergy(space, e, well, c).gradient(); }, r);
}

void add_tangent(const SurfaceSpace& space, const physics::DoubleWell& well, double factor,
                 VecView c, CsrMatrix& matrix) {
  add_element_matrices(
      space,
      [&](const CutElement&, int e) -> Eigen::Matrix4d {
        return factor * ElementEnergy(space, static_cast<std::size_t>(e), well, c).second();
      },
      matrix);
}

void add_tangent_product(const SurfaceSpace& space, const physics::DoubleWell& well, double factor,
                         VecView c, VecView v, VecRef r) {
  add_element_loads(
      space, factor,
      [&](std::size_t e) {
        return ElementEnergy(space, e, well, c).second(values_at(space.elements[e], v));
      },
      r);
}

double energy(const SurfaceSpace& space, const physics::DoubleWell& well, VecView c) {
  return space.team->sum(space.elements.size(), [&](std::size_t e, double& total) {
    if (space.mesh.owns(space.mesh.tets[e])) total += ElementEnergy(space, e, well, c).value();
  });
}

}  // namespace traceraft::fem::averaged_potential
