// Noise that neighbours share, on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "drivers/campaign/shared_noise.hpp"
#include "drivers/config/number_checks.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {

inline void add_noise_options(CLI::App& command, SharedNoise& noise) {
  command
      .add_option("--noise-correlation", noise.length,
                  "length in R over which neighbours share noise: the standard deviation of a "
                  "Gaussian")
      ->check(between(kShortestDrawn, kLongestDrawn));
  command.add_option("--noise-share", noise.share, "how much of the noise's variance they share")
      ->check(between(0, 1));
  command
      .add_option("--noise-shape", noise.shape,
                  "of that correlation: gaussian or exponential; explain assumes neither")
      ->type_name(joined(shared_noise_shapes(), "|"))
      ->capture_default_str();
}

}  // namespace traceraft
