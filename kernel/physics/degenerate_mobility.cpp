#include "kernel/physics/mobility.hpp"

namespace traceraft {
namespace {

// M(c) = c(1 − c): lipids move in the interface only.
class Degenerate final : public Mobility {
 public:
  void evaluate(const double* c, int count, double* value, double* derivative) const override {
    for (int i = 0; i < count; ++i) value[i] = c[i] * (1 - c[i]);
    if (derivative)
      for (int i = 0; i < count; ++i) derivative[i] = 1 - 2 * c[i];
  }
  double scale() const override { return 1.0; }
};

}  // namespace

MobilityEntry degenerate_mobility() {
  return {"degenerate", "D c(1-c), transport along the interface", {}, [](const Parameters&) {
            return std::make_shared<Degenerate>();
          }};
}

}  // namespace traceraft
