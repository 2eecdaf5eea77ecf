#include "kernel/physics/mobility.hpp"

namespace traceraft::physics {
namespace {

// M(c) = c(1 − c): lipids move in the interface only. Curved phase boundaries push c out of [0, 1]
// by some ε/R (Gibbs–Thomson), where the formula is negative; there M(c) = outside · |c(1 − c)|.
// The formula itself, outside = −1, is left to the floor of its mean over each tetrahedron.
class Degenerate final : public Mobility {
 public:
  explicit Degenerate(double outside) : outside_(outside) {}

  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    for (int i = 0; i < count; ++i) {
      const double inside = c[i] * (1 - c[i]);
      value[i] = inside >= 0 ? inside : -outside_ * inside;
      if (derivative) derivative[i] = (inside >= 0 ? 1 : -outside_) * (1 - 2 * c[i]);
    }
  }
  double scale() const override { return 1.0; }

 private:
  double outside_;
};

}  // namespace

MobilityEntry degenerate_mobility() {
  return {"degenerate",
          "D |c(1-c)|, transport along the interface",
          {{"outside", "", 1, -1, 1,
            "factor for c outside of [0, 1]; -1: c(1-c) itself, as in the reference code"}},
          [](const Parameters& p) { return std::make_shared<Degenerate>(p["outside"]); }};
}

}  // namespace traceraft::physics
