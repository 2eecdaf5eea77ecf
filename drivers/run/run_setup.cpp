#include "drivers/run/run_setup.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <thread>

#include "backends/list.hpp"
#include "backends/muparser/formula.hpp"
#include "backends/ranks.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/problem/initial_data.hpp"

namespace traceraft {
namespace {

// Runs `make`, so that what it finds wrong is said of the place where the option was given.
template <class Make>
auto said_of(const Configuration& configuration, const char* option, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(configuration.where(option) + ": " + error.what());
  }
}

// The text of an option that must be one of a few words.
std::string one_of(const Configuration& configuration, const char* option, const char* kind,
                   const std::vector<std::string>& words) {
  const std::string word = configuration.text(option);
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw InputError(configuration.where(option) + ": " + unknown_name_message(kind, word, words));
  return word;
}

// Given on the command line? A configuration file holds every option.
bool from_flag(const Configuration& configuration, const std::string& option) {
  return configuration.given(option) && configuration.where(option).compare(0, 2, "--") == 0;
}

int thread_count(const Configuration& configuration, const Communicator& ranks) {
  const int asked = static_cast<int>(configuration.integer("threads"));
  if (ranks.size() > 1) {
    // A run of one rank may have had two, and goes on with more ranks.
    if (asked > 1 && from_flag(configuration, "threads"))
      throw InputError(configuration.where("threads") +
                       ": several ranks have one thread each; start more ranks instead");
    return 1;
  }
  if (asked > 0) return asked;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 2);
}

std::vector<CapRaft> parse_caps(const Configuration& configuration) {
  std::vector<CapRaft> caps;
  std::istringstream list(configuration.text("initial-caps"));
  const std::string where = configuration.where("initial-caps");
  for (std::string item; std::getline(list, item, ';');) {
    std::istringstream words(item);
    std::vector<double> numbers;
    for (std::string word; words >> word;) numbers.push_back(parse_number(where, word));
    if (numbers.empty()) continue;
    if (numbers.size() != 4)
      throw InputError(where + ": '" + item + "' needs four numbers, x y z angle");
    const Point direction(numbers[0], numbers[1], numbers[2]);
    if (direction.norm() == 0) throw InputError(where + ": a direction is zero in '" + item + "'");
    if (!(numbers[3] > 0 && numbers[3] < 180))
      throw InputError(where + ": an angle must lie between 0 and 180 degrees in '" + item + "'");
    caps.push_back({direction, numbers[3] * kPi / 180});
  }
  return caps;
}

// Data for another kind of initial state than the case's are a mistake, not something to ignore.
void require_kind(const Configuration& configuration, const char* option, const char* kind) {
  if (configuration.given(option) &&
      (from_flag(configuration, option) || !configuration.given("initial")) &&
      split_named_arguments(configuration.text("initial")).name != kind)
    throw InputError(configuration.where(option) + ": it needs --initial " + kind);
}

InitialRequest initial_request(const Configuration& configuration, const CahnHilliardModel& model) {
  InitialRequest request;
  const long long cells = configuration.integer("cells");
  request.raft_fraction = configuration.number("raft-fraction");
  request.noise_cells = configuration.noise_cells();
  if (request.noise_cells > cells)
    throw InputError(configuration.where("noise-cells") + ": " +
                     std::to_string(request.noise_cells) + " is more than --cells " +
                     std::to_string(cells));
  request.seed = static_cast<std::uint64_t>(configuration.integer("seed"));
  request.caps = parse_caps(configuration);
  if (const std::string formula = configuration.text("initial-formula"); !formula.empty())
    request.formula = parse_formula(configuration.where("initial-formula"), formula);
  request.epsilon = model.epsilon;
  request.well = model.well;
  return request;
}

Vec initial_field(const Configuration& configuration, const CahnHilliardModel& model,
                  const SurfaceSpace& space) {
  const std::string kind = configuration.text("initial");
  require_kind(configuration, "initial-formula", "formula");
  require_kind(configuration, "initial-caps", "caps");
  const InitialRequest request = initial_request(configuration, model);
  return said_of(configuration, "initial", [&] {
    const auto [name, folder] = split_named_arguments(kind);
    if (name == "restart") {
      const bool root = space.communicator->root();
      const int nodes = static_cast<int>(space.totals.nodes);
      return space.order.scattered(
          root ? final_concentration(folder, nodes, numerical_identity(configuration)) : Vec());
    }
    (void)initial_fields().find(name, {"restart:DIR"});
    return make_initial_field(kind, space, request);
  });
}

// On the run's own mesh if it is a sphere, else on a sphere of the same mesh size.
PerimeterCalibration perimeter_calibration(const Configuration& configuration,
                                           const CahnHilliardModel& model,
                                           const std::shared_ptr<const SurfaceSpace>& space) {
  const auto sphere = configuration.text("surface") == "sphere"
                          ? space
                          : std::make_shared<const SurfaceSpace>(*make_surface("sphere"),
                                                                 configuration.integer("cells"),
                                                                 space->team, space->communicator);
  return calibrate_perimeter(*sphere, model);
}

// In the user's units.
std::vector<double> output_labels(const Configuration& configuration) {
  constexpr int kDefaultTimes = 16;
  const double end = configuration.number("t-end");
  std::vector<double> times = configuration.numbers("output-times");
  if (times.empty()) {
    times.push_back(0);
    for (int i = 1; i <= kDefaultTimes; ++i)  // four decades, the end last
      times.push_back(end * std::pow(10.0, 4.0 * (i - kDefaultTimes) / kDefaultTimes));
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  if (times.back() > end)
    throw InputError(configuration.where("output-times") + ": " + format_number(times.back()) +
                     " is after the end of the run, " + configuration.text("t-end"));
  return times;
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
  for (const LinearSolverEntry& other : linear_solvers())
    for (const WordOption& option : other.options) {
      const std::string name = linear_solver_option(other, option);
      if (other.name == solver.name)
        options[option.name] = configuration.text(name);
      else if (from_flag(configuration, name))
        throw InputError(configuration.where(name) + ": it needs --linear-solver " + other.name);
    }
  try {
    return choose_linear_solver(solver.name, space, options);
  } catch (const OptionError& error) {
    throw InputError(configuration.where(solver.name + "-" + error.option) + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(configuration.where("linear-solver") + ": " + error.what());
  }
}

}  // namespace

DoubleWell double_well(const Configuration& configuration) {
  return said_of(configuration, "well", [&] {
    const Parameters p = parse_parameters("double well", configuration.text("well"),
                                          {{"rho", "", 0.25, 1e-12, 1e12, "height"},
                                           {"a", "", 0, -1e6, 1e6, "first minimum"},
                                           {"b", "", 1, -1e6, 1e6, "second minimum"}});
    if (!(p["a"] < p["b"])) throw InputError("double well: a must be smaller than b");
    return DoubleWell{p["rho"], p["a"], p["b"]};
  });
}

LevelSetPtr surface_of(const Configuration& configuration) {
  const std::string formula = configuration.text("surface-formula");
  if (configuration.text("surface") == "formula") {
    if (formula.empty())
      throw InputError(configuration.where("surface") +
                       ": formula needs --surface-formula, as in "
                       "--surface-formula \"x^2+y^2+2*z^2-1\"");
    return std::make_shared<FunctionLevelSet>(
        parse_formula(configuration.where("surface-formula"), formula));
  }
  if (!formula.empty())
    throw InputError(configuration.where("surface-formula") + ": it needs --surface formula");
  return said_of(configuration, "surface", [&] {
    const std::string specification = configuration.text("surface");
    (void)surfaces().find(split_named_arguments(specification).name, {"formula"});
    return make_surface(specification);
  });
}

CahnHilliardModel physical_model(const Configuration& configuration) {
  const Units units = configuration.units();
  CahnHilliardModel result;
  result.mobility = said_of(configuration, "mobility",
                            [&] { return make_mobility(configuration.text("mobility")); });
  result.well = double_well(configuration);
  if (!result.mobility->constant() && (result.well.a != 0 || result.well.b != 1))
    throw InputError(configuration.where("well") +
                     ": the degenerate mobility c(1-c) belongs to wells at 0 and 1; choose "
                     "--mobility constant:value=0.25");
  result.epsilon = configuration.number("epsilon") / units.length();
  result.rule = one_of(configuration, "potential", "potential", {"consistent", "nodal"}) == "nodal"
                    ? PotentialRule::nodal
                    : PotentialRule::consistent;
  result.stabilisation = configuration.number("stabilisation");
  result.seed = static_cast<std::uint64_t>(configuration.integer("seed"));
  said_of(configuration, "effect", [&] {
    add_effects(configuration.text("effect"), units, result);
    return 0;
  });
  return result;
}

RunSetup build_run(const Configuration& configuration, InitialState initial) {
  RunSetup run;
  run.units = configuration.units();
  run.t_end = configuration.number("t-end") / run.units.time();
  run.output_labels = output_labels(configuration);
  for (const double label : run.output_labels)
    run.output_times.push_back(std::min(label / run.units.time(), run.t_end));
  const CahnHilliardModel physics = physical_model(configuration);
  const IntegratorEntry& integrator = said_of(configuration, "integrator", [&] {
    return std::cref(integrators().find(configuration.text("integrator")));
  });
  const IntegratorSettings settings = integrator_settings(configuration, integrator, run.units);
  said_of(configuration, "linear-solver",
          [&] { return linear_solvers().find(configuration.text("linear-solver")).name; });

  run.ranks = world();
  run.team = std::make_shared<ThreadTeam>(thread_count(configuration, *run.ranks));
  const LevelSetPtr surface = surface_of(configuration);
  run.space = said_of(configuration, "surface", [&] {
    return std::make_shared<const SurfaceSpace>(*surface, configuration.integer("cells"), run.team,
                                                run.ranks);
  });
  said_of(configuration, "effect", [&] {
    for (const EffectPtr& effect : physics.effects) effect->require_surface(*run.space);
    return 0;
  });
  run.problem = std::make_unique<CahnHilliard>(run.space, physics);
  if (settings.reject_energy_rises && !run.problem->dissipates_energy())
    throw InputError(configuration.where("energy-guard") +
                     ": reject is for models that can only lose energy, and this one need not; "
                     "choose warn or off");
  if (initial == InitialState::build) {
    run.initial = initial_field(configuration, physics, *run.space);
    run.initial_mean = run.space->integral(run.initial) / run.space->area;
  }
  run.perimeter = perimeter_calibration(configuration, physics, run.space);
  run.observer =
      std::make_unique<Observer>(*run.problem, run.space, run.perimeter.interface_energy);
  const LinearSolverChoice solvers = linear_solver(configuration, *run.space);
  run.integrator = integrator.make(*run.problem, solvers, run.team, settings);
  return run;
}

Status start_run(RunSetup& run) {
  Vec y(run.problem->size()), ydot(run.problem->size());
  y.head(run.problem->block_size()) = run.initial;
  if (Status status = run.problem->consistent_initial_state(0, y, ydot); !status.ok())
    return status;
  return run.integrator->start(0, y, ydot, run.t_end);
}

}  // namespace traceraft
