// Errors that data state, as those of what is expected instead of what was measured: by the latter,
// looks that noise has made large would weigh more than others, or less, and pull with them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "verification/observations/measurements.hpp"

namespace traceraft::observations {

// The stated error of one value: σ goes with the power of what is expected.
struct StatedError {
  double ln_sigma;  // where 1 is expected; −inf if nothing is stated
  double power;
  bool counted;  // a whole number, and 1 at least

  // Variances of ln of the value: what is stated, and with that of rounding.
  double stated(double ln_expected) const;
  double of_logarithm(double ln_expected) const;
  // Mean of ln of the value minus ln of what is expected, where values that are not positive are
  // not looked at. 0 of relative errors unless of counts: they are taken as normal in the
  // logarithm.
  double bias(double ln_expected) const;
  // ln of a value with such an error; `normal`: the k-th of its normal numbers.
  double drawn(double ln_value, const std::function<double(std::uint64_t)>& normal) const;
};

// The laws of errors, one per quantity: σ = s value^b fits what the looks after time zero state,
// absolute errors or relative ones, 0 <= b <= 1. A look that states another error has that, unless
// noise in its value may be the reason.
class StatedErrors {
 public:
  explicit StatedErrors(const MeasuredVesicles& data);

  double power(Quantity quantity) const { return law(quantity).power; }
  // The error of a measurement. That of a value which is not positive, and which the law does not
  // know, is as it is stated.
  StatedError of(const Measurement& m, Quantity quantity) const;

 private:
  struct Law {
    double power = 0, ln_scale = 0;
  };
  const Law& law(Quantity quantity) const { return laws_[index_of(quantity)]; }
  static Law law_of(const MeasuredVesicles& data, Quantity quantity);

  std::array<Law, kQuantities.size()> laws_{};
};

}  // namespace traceraft::observations
