// Physical units and the program's own: lengths in R, times in R²/D.
#pragma once

namespace traceraft::physics {

struct Units {
  double radius_um = 5.0;         // R in µm
  double diffusion_cm2_s = 1e-5;  // D in cm²/s
  bool scaled = false;            // true: inputs and outputs are in units of R and R²/D

  static constexpr double kUm2PerCm2 = 1e8;
  double seconds_per_unit() const { return radius_um * radius_um / (diffusion_cm2_s * kUm2PerCm2); }
  // The units with the D (cm²/s) for which R²/D is so many seconds.
  Units with_seconds_per_unit(double seconds) const {
    return {radius_um, radius_um * radius_um / (seconds * kUm2PerCm2), scaled};
  }
  // Factors from the program's units to those of inputs and outputs.
  double length() const { return scaled ? 1.0 : radius_um; }
  double area() const { return length() * length(); }
  double time() const { return scaled ? 1.0 : seconds_per_unit(); }
};

}  // namespace traceraft::physics
