// The simulations behind a calibration: an ensemble for every choice of the parameters.
#pragma once

#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "drivers/ensemble/ensemble_point.hpp"
#include "kernel/core/named_list.hpp"
#include "verification/calibration/calibration.hpp"
#include "verification/statistics/bootstrap.hpp"

namespace traceraft::calibrate {

// An option that can be calibrated besides D, which costs no simulation.
struct CalibratedOption {
  std::string name;    // on the command line
  std::string option;  // of a run
};
const NamedList<CalibratedOption>& calibrated_options();

// The configuration of a run with these values (not logarithms) of the options. Where `epsilon` is
// smaller than in the model there are as many more cells, a multiple of 4, so that h/ε is not
// larger; the noise stays on its mesh unless it is calibrated itself. Throws InputError for values
// that cannot be run.
config::Configuration configuration_at(const config::Configuration& model,
                                       const std::vector<std::string>& parameters,
                                       const std::vector<double>& values, double t_end);

// The range of a parameter in simulations of the model: rafts and something between them, noise
// that its meshes can hold, ε that so many cells resolve as well as the model's do. Both ends are
// positive.
statistics::Interval range_of(const config::Configuration& model, const std::string& parameter,
                              int most_cells);

// Where the parameters of the model are; of noise lengths, what its meshes make of them.
std::vector<double> values_of(const config::Configuration& model,
                              const std::vector<std::string>& parameters);

}  // namespace traceraft::calibrate
