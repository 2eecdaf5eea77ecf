// The sum of the logarithms of many positive numbers, at the price of few logarithms.
#pragma once

#include <cmath>

namespace traceraft::statistics {

class LogOfProduct {
 public:
  // x: from 1e-200 to 1e200.
  void multiply(double x) {
    product_ *= x;
    if (product_ > 1e-100 && product_ < 1e100) return;
    sum_ += std::log(product_);
    product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  double sum_ = 0, product_ = 1;
};

}  // namespace traceraft::statistics
