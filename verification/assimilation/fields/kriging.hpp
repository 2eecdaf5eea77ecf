// A field on Γ from values whose noise neighbours share. The same posterior as field_estimate has,
// in the space of the values, where covariances of noise may have any shape.
#pragma once

#include "verification/assimilation/fields/field_estimate.hpp"
#include "verification/assimilation/fields/noise_correlation.hpp"

namespace traceraft::assimilation {

struct CorrelatedNoise {
  double level;  // standard deviation, in units of the values' `deviation`
  NoiseCorrelation correlation;
};

class Kriging {
 public:
  // The mean is that of the values; the prior, whose `smoothing` is in units of the noise's level,
  // maximises the likelihood of some of the values, begun at `near`. Of more values than
  // kMostKriged some are left out. Serial spaces, which must outlive this object. Throws
  // std::runtime_error if the field cannot be estimated.
  Kriging(const fem::SurfaceSpace& space, const NoisyValues& measured,
          const std::vector<Point>& points, const CorrelatedNoise& noise, const FieldPrior& near);
  ~Kriging();

  FieldEstimate estimate(const ErrorRequest& wanted) const;
  // The field on another mesh of the surface, `trace` being that of all values there.
  Vec field_on(const fem::SurfaceSpace& other, const PointTrace& trace) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

inline constexpr Eigen::Index kMostKriged = 6000;

}  // namespace traceraft::assimilation
