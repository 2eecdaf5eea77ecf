#include "drivers/run/numerical_methods.hpp"

#include <algorithm>

#include "drivers/run/checked_options.hpp"

namespace traceraft {
namespace {

void refuse_without(const std::vector<std::string>& chosen, const Configuration& configuration,
                    const std::string& option, const char* kind, const std::string& name) {
  if (from_flag(configuration, option) &&
      std::find(chosen.begin(), chosen.end(), name) == chosen.end())
    throw InputError(configuration.where(option) + ": it needs the " + kind + " " + name);
}

}  // namespace

NumericalMethods methods_of_run(const Configuration& configuration) {
  return {{configuration.text("integrator")}, {configuration.text("linear-solver")}};
}

void refuse_options_of_others(const Configuration& configuration, const NumericalMethods& methods) {
  refuse_without(methods.integrators, configuration, "keep", "integrator", "euler");
  for (const IntegratorEntry& integrator : integrators())
    for (const ParameterSpec& parameter : integrator.parameters)
      refuse_without(methods.integrators, configuration, integrator_option(integrator, parameter),
                     "integrator", integrator.name);
  for (const LinearSolverEntry& solver : linear_solvers())
    for (const WordOption& option : solver.options)
      refuse_without(methods.linear_solvers, configuration, linear_solver_option(solver, option),
                     "linear solver", solver.name);
}

IntegratorSettings integrator_settings(const Configuration& configuration,
                                       const IntegratorEntry& integrator, const Units& units) {
  IntegratorSettings settings;
  for (const ParameterSpec& parameter : integrator.parameters)
    settings.own[parameter.name] = configuration.number(integrator_option(integrator, parameter)) /
                                   (parameter.unit == "s" ? units.time() : 1);
  settings.tolerance = configuration.number("tolerance");
  settings.initial_step = configuration.number("initial-step") / units.time();
  settings.min_step = configuration.number("min-step") / units.time();
  settings.max_step = configuration.number("max-step") / units.time();
  settings.linear_tolerance = configuration.number("linear-tolerance");
  settings.kept_solution =
      one_of(configuration, "keep", "solution", {"decaying", "second", "first"});
  settings.reject_energy_rises =
      one_of(configuration, "energy-guard", "guard", {"warn", "reject", "off"}) == "reject";
  for (const char* largest : {"max-step", "ida-maxstep"})
    if (const double most = configuration.number(largest) / units.time();
        most > 0 && settings.min_step > most)
      throw InputError(configuration.where("min-step") + ": it is larger than --" + largest);
  return settings;
}

LinearSolverChoice linear_solver(const Configuration& configuration, const SurfaceSpace& space) {
  const LinearSolverEntry& solver = linear_solvers().find(configuration.text("linear-solver"));
  WordOptions options;
  for (const WordOption& option : solver.options)
    options[option.name] = configuration.text(linear_solver_option(solver, option));
  try {
    return choose_linear_solver(solver.name, space, options);
  } catch (const OptionError& error) {
    throw InputError(configuration.where(solver.name + "-" + error.option) + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(configuration.where("linear-solver") + ": " + error.what());
  }
}

}  // namespace traceraft
