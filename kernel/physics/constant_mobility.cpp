#include <algorithm>

#include "kernel/physics/mobility.hpp"

namespace traceraft::physics {
namespace {

class Constant final : public Mobility {
 public:
  explicit Constant(double m) : m_(m) {}
  void evaluate(const double*, int count, double* value, double* derivative) const override {
    std::fill(value, value + count, m_);
    if (derivative) std::fill(derivative, derivative + count, 0.0);
  }
  double scale() const override { return m_; }
  bool constant() const override { return true; }

 private:
  double m_;
};

}  // namespace

MobilityEntry constant_mobility() {
  return {"constant",
          "D times a constant, transport through the phases",
          {{"value", "D", 0.25, 1e-12, 1e12, "the mobility; 0.25 is the maximum of c(1-c)"}},
          [](const Parameters& p) { return std::make_shared<Constant>(p["value"]); }};
}

}  // namespace traceraft::physics
