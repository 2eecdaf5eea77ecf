// Noise that neighbours share, on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "drivers/campaign/shared_noise.hpp"
#include "drivers/config/number_checks.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::campaign {

inline void add_noise_options(CLI::App& command, SharedNoise& noise) {
  command
      .add_option(
          "--noise-correlation", noise.length,
          "correlation length of shared noise, in units of R: the standard deviation of a Gaussian")
      ->check(config::between(kShortestDrawn, kLongestDrawn));
  command
      .add_option("--noise-share", noise.share,
                  "share of the noise's variance that is correlated between neighbours")
      ->check(config::between(0, 1));
  command
      .add_option("--noise-shape", noise.shape,
                  "shape of this correlation: gaussian or exponential; explain does not know which")
      ->type_name(joined(shared_noise_shapes(), "|"))
      ->capture_default_str();
}

}  // namespace traceraft::campaign
