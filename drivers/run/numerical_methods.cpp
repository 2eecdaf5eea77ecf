#include "drivers/run/numerical_methods.hpp"

#include "drivers/run/checked_options.hpp"

namespace traceraft {

IntegratorSettings integrator_settings(const Configuration& configuration,
                                       const IntegratorEntry& integrator, const Units& units) {
  IntegratorSettings settings;
  for (const ParameterSpec& parameter : integrator.parameters)
    settings.method_options[parameter.name] =
        configuration.options().method_numbers.at(integrator_option(integrator, parameter)) /
        (parameter.unit == "s" ? units.time() : 1);
  settings.tolerance = configuration.options().tolerance;
  settings.initial_step = configuration.options().initial_step / units.time();
  settings.min_step = configuration.options().min_step / units.time();
  settings.max_step = configuration.options().max_step / units.time();
  settings.linear_tolerance = configuration.options().linear_tolerance;
  settings.kept_solution = one_of(configuration, &RunOptions::keep, "solution");
  settings.reject_energy_rises =
      one_of(configuration, &RunOptions::energy_guard, "guard") == "reject";
  for (const char* largest : {"max-step", "ida-maxstep"})
    if (const double most = configuration.numbers(run_option(largest))[0] / units.time();
        most > 0 && settings.min_step > most)
      throw InputError(configuration.where(&RunOptions::min_step) + ": it is larger than --" +
                       largest);
  return settings;
}

LinearSolverChoice linear_solver(const Configuration& configuration, const SurfaceSpace& space) {
  const LinearSolverEntry& solver = linear_solvers().find(configuration.options().linear_solver);
  WordOptions options;
  for (const WordOption& option : solver.options)
    options[option.name] =
        configuration.options().method_words.at(linear_solver_option(solver, option));
  try {
    return choose_linear_solver(solver.name, space, options);
  } catch (const OptionError& error) {
    throw InputError(configuration.where(solver.name + "-" + error.option) + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(configuration.where(&RunOptions::linear_solver) + ": " + error.what());
  }
}

}  // namespace traceraft
