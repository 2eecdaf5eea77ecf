#include "drivers/calibrate/calibration_points.hpp"

#include <cmath>

#include "drivers/ensemble/ensemble_point.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/mesh/cube_mesh.hpp"

namespace traceraft::calibrate {
namespace {

constexpr double kFewestNoiseCells = 4;
constexpr double kRounding = 5e-4;  // of values that are written with four digits
constexpr statistics::Interval kFractions = {0.02, 0.9};

// Cells, a multiple of 4, with which the mesh is no coarser against ε than the model's.
int cells_for(const config::Configuration& model, double epsilon) {
  const double cells = static_cast<double>(model.options().cells);
  const double needed = cells * std::max(1.0, model.options().epsilon / epsilon);
  return 4 * static_cast<int>(std::ceil(needed / 4 * (1 - kRounding)));
}

double box_width(const config::Configuration& model) {
  return 2 * mesh::kBoxHalfWidth * model.units().length();
}

}  // namespace

const NamedList<CalibratedOption>& calibrated_options() {
  static const NamedList<CalibratedOption> list("name in --parameters",
                                                {{"mobility", ""},
                                                 {"epsilon", "epsilon"},
                                                 {"fraction", "raft-fraction"},
                                                 {"noise-length", ""}});
  return list;
}

statistics::Interval range_of(const config::Configuration& model, const std::string& parameter,
                              int most_cells) {
  const double box = box_width(model), cells = static_cast<double>(model.options().cells);
  if (parameter == "noise-length") return {box / cells, box / kFewestNoiseCells};
  if (parameter == "fraction") return kFractions;
  return {model.options().epsilon * cells / most_cells, 0.5 * model.units().length()};
}

std::vector<double> values_of(const config::Configuration& model,
                              const std::vector<std::string>& parameters) {
  std::vector<double> values;
  for (const std::string& name : parameters)
    values.push_back(name == "noise-length" ? model.noise_length()
                                            : model.numbers(config::run_option(
                                                  calibrated_options().find(name).option))[0]);
  return values;
}

config::Configuration configuration_at(const config::Configuration& model,
                                       const std::vector<std::string>& parameters,
                                       const std::vector<double>& values, double t_end) {
  config::GivenValues given = ensemble::settings_until(model, t_end);
  const auto set = [&](const std::string& option, const std::string& text) {
    given[option] = {text, "--" + option};
  };
  double length = model.noise_length(), epsilon = model.options().epsilon;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i] == "noise-length")
      length = values[i];
    else
      set(calibrated_options().find(parameters[i]).option, format_number(values[i]));
    if (parameters[i] == "epsilon") epsilon = values[i];
  }
  const int cells = cells_for(model, epsilon);
  const auto noise = static_cast<int>(std::lround(box_width(model) / length));
  set("cells", std::to_string(cells));
  set("noise-cells", std::to_string(std::min(noise, cells)));
  return {{}, given};
}

}  // namespace traceraft::calibrate
