// The settings of IDA: its own options, and the general ones where those are not set.
#pragma once

#include <vector>

#include "kernel/core/parameters.hpp"
#include "kernel/time/integrator.hpp"

namespace traceraft::sundials {

// The options that IDA has beyond the general ones, under IDA's names. 0 leaves an option that has
// a general counterpart to that.
std::vector<ParameterSpec> ida_parameters();

class IdaSettings {
 public:
  explicit IdaSettings(const time::IntegratorSettings& settings);

  const time::IntegratorSettings& general() const { return settings_; }
  // By its name in ida_parameters().
  double option(const char* name) const { return settings_.method_options.at(name); }
  double rtol() const { return either("rtol", settings_.tolerance); }
  double atol() const { return either("atol", 1e-10); }
  // The tolerance of the first correction of a step, 0, and of those after it, which are smaller
  // and need not be as accurate.
  double linear_tolerance(int correction) const;
  // Infinite if none is set; the problem may want a shorter one.
  double max_step() const;
  double min_step(double span) const;

 private:
  double either(const char* name, double general) const {
    return option(name) > 0 ? option(name) : general;
  }

  time::IntegratorSettings settings_;
};

}  // namespace traceraft::sundials
