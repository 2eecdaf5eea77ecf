#include "drivers/run/physical_model.hpp"

#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "backends/muparser/formula.hpp"
#include "drivers/run/checked_options.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::run {

physics::DoubleWell double_well(const config::Configuration& configuration) {
  return with_option_context(configuration, &config::RunOptions::well, [&] {
    const Parameters p = parse_parameters("double well", configuration.options().well,
                                          {{"rho", "", 0.25, 1e-12, 1e12, "height"},
                                           {"a", "", 0, -1e6, 1e6, "first minimum"},
                                           {"b", "", 1, -1e6, 1e6, "second minimum"}});
    if (!(p["a"] < p["b"])) throw InputError("double well: a must be smaller than b");
    return physics::DoubleWell{p["rho"], p["a"], p["b"]};
  });
}

namespace {

// Squares of values beyond 1e±150 leave the range of numbers. A factor moves no surface.
std::function<double(const Point&)> of_usual_size(std::function<double(const Point&)> phi) {
  constexpr double kUsual = 1e100;
  double largest = 0;
  for (const Point& x : {Point(0, 0, 0), Point(1.5, 0, 0), Point(0, 1.5, 0), Point(0, 0, 1.5),
                         Point(1.5, 1.5, 1.5), Point(-1, -1.5, 0.5)})
    if (const double value = std::fabs(phi(x)); std::isfinite(value))
      largest = std::max(largest, value);
  if (largest == 0 || (largest < kUsual && largest > 1 / kUsual)) return phi;
  return [phi = std::move(phi), largest](const Point& x) { return phi(x) / largest; };
}

}  // namespace

geometry::LevelSetPtr surface_of(const config::Configuration& configuration) {
  const std::string formula = configuration.options().surface_formula;
  if (configuration.options().surface == "formula") {
    if (formula.empty())
      throw InputError(configuration.where(&config::RunOptions::surface) +
                       ": formula needs --surface-formula, as in "
                       "--surface-formula \"x^2+y^2+2*z^2-1\"");
    return std::make_shared<geometry::FunctionLevelSet>(of_usual_size(muparser::parse_formula(
        configuration.where(&config::RunOptions::surface_formula), formula)));
  }
  if (!formula.empty())
    throw InputError(configuration.where(&config::RunOptions::surface_formula) +
                     ": it needs --surface formula");
  return with_option_context(configuration, &config::RunOptions::surface, [&] {
    const std::string specification = configuration.options().surface;
    (void)geometry::surfaces().find(split_named_arguments(specification).name, {"formula"});
    return geometry::make_surface(specification);
  });
}

problem::CahnHilliardModel model_without_effects(const config::Configuration& configuration) {
  const physics::Units units = configuration.units();
  problem::CahnHilliardModel result;
  result.mobility = with_option_context(configuration, &config::RunOptions::mobility, [&] {
    return physics::make_mobility(configuration.options().mobility);
  });
  result.well = double_well(configuration);
  if (!result.mobility->constant() && (result.well.a != 0 || result.well.b != 1))
    throw InputError(configuration.where(&config::RunOptions::well) +
                     ": the degenerate mobility c(1-c) needs wells at 0 and 1; choose --mobility "
                     "constant:value=0.25 for others");
  result.epsilon = configuration.options().epsilon / units.length();
  const std::string rule = one_of(configuration, &config::RunOptions::potential, "potential");
  result.rule = rule == "averaged"     ? fem::PotentialRule::averaged
                : rule == "consistent" ? fem::PotentialRule::consistent
                                       : fem::PotentialRule::nodal;
  result.stabilisation = configuration.options().stabilisation;
  result.mass_stabilisation = configuration.options().mass_stabilisation;
  result.seed = static_cast<std::uint64_t>(configuration.options().seed);
  return result;
}

std::vector<effects::EffectTerm> effects_of(const config::Configuration& configuration) {
  return with_option_context(configuration, &config::RunOptions::effect, [&] {
    return effects::read_effects(configuration.options().effect, configuration.units());
  });
}

problem::CahnHilliardModel physical_model(const config::Configuration& configuration) {
  problem::CahnHilliardModel result = model_without_effects(configuration);
  with_option_context(configuration, &config::RunOptions::effect, [&] {
    effects::add_effects(configuration.options().effect, configuration.units(), result);
  });
  return result;
}

}  // namespace traceraft::run
