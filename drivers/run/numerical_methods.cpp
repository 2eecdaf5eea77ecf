#include "drivers/run/numerical_methods.hpp"

#include "drivers/run/checked_options.hpp"

namespace traceraft::run {

time::IntegratorSettings integrator_settings(const config::Configuration& configuration,
                                             const backends::IntegratorEntry& integrator,
                                             const physics::Units& units) {
  time::IntegratorSettings settings;
  for (const ParameterSpec& parameter : integrator.parameters)
    settings.method_options[parameter.name] =
        configuration.options().method_numbers.at(
            config::method_option(integrator.name, parameter)) /
        (parameter.unit == "s" ? units.time() : 1);
  settings.tolerance = configuration.options().tolerance;
  settings.initial_step = configuration.options().initial_step / units.time();
  settings.min_step = configuration.options().min_step / units.time();
  settings.max_step = configuration.options().max_step / units.time();
  settings.linear_tolerance = configuration.options().linear_tolerance;
  settings.kept_solution = one_of(configuration, &config::RunOptions::keep, "solution");
  settings.reject_energy_rises =
      one_of(configuration, &config::RunOptions::energy_guard, "guard") == "reject";
  for (const char* largest : {"max-step", "ida-maxstep"})
    if (const double most = configuration.numbers(config::run_option(largest))[0] / units.time();
        most > 0 && settings.min_step > most)
      throw InputError(configuration.where(&config::RunOptions::min_step) +
                       ": it is larger than --" + largest);
  return settings;
}

linear::LinearSolverChoice linear_solver(const config::Configuration& configuration,
                                         const fem::SurfaceSpace& space) {
  const backends::LinearSolverEntry& solver =
      backends::linear_solvers().find(configuration.options().linear_solver);
  backends::WordOptions options;
  for (const ParameterSpec& parameter : solver.parameters)
    options[parameter.name] =
        configuration.options().method_words.at(config::method_option(solver.name, parameter));
  try {
    return backends::choose_linear_solver(solver.name, space, options);
  } catch (const OptionError& error) {
    throw InputError(configuration.where(solver.name + "-" + error.option) + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(configuration.where(&config::RunOptions::linear_solver) + ": " + error.what());
  }
}

}  // namespace traceraft::run
