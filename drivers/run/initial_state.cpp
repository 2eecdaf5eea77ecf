#include "drivers/run/initial_state.hpp"

#include <sstream>

#include "backends/muparser/formula.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/earlier_run.hpp"
#include "drivers/run/physical_model.hpp"
#include "kernel/problem/initial_data.hpp"

namespace traceraft::run {
namespace {

std::vector<problem::CapRaft> parse_caps(const config::Configuration& configuration) {
  std::vector<problem::CapRaft> caps;
  std::istringstream list(configuration.options().initial_caps);
  const std::string where = configuration.where(&config::RunOptions::initial_caps);
  for (std::string item; std::getline(list, item, ';');) {
    std::istringstream words(item);
    std::vector<double> numbers;
    for (std::string word; words >> word;) numbers.push_back(parse_number(where, word));
    if (numbers.empty()) continue;
    if (numbers.size() != 4)
      throw InputError(where + ": '" + item + "' must have four numbers, x y z angle");
    const Point direction(numbers[0], numbers[1], numbers[2]);
    if (direction.isZero(0)) throw InputError(where + ": a direction is zero in '" + item + "'");
    if (!(numbers[3] > 0 && numbers[3] < 180))
      throw InputError(where + ": an angle must lie between 0 and 180 degrees in '" + item + "'");
    caps.push_back({direction, numbers[3] * kPi / 180});
  }
  return caps;
}

// The part of a request that needs no mesh.
problem::InitialRequest basic_request(const config::Configuration& configuration,
                                      const problem::CahnHilliardModel& model) {
  problem::InitialRequest request;
  request.raft_fraction = configuration.options().raft_fraction;
  request.seed = static_cast<std::uint64_t>(configuration.options().seed);
  request.caps = parse_caps(configuration);
  request.epsilon = model.epsilon;
  request.well = model.well;
  return request;
}

problem::InitialRequest initial_request(const config::Configuration& configuration,
                                        const problem::CahnHilliardModel& model) {
  const long long cells = configuration.options().cells;
  problem::InitialRequest request = basic_request(configuration, model);
  request.noise_cells = configuration.noise_cells();
  if (request.noise_cells > cells)
    throw InputError(configuration.where(&config::RunOptions::noise_cells) + ": " +
                     std::to_string(request.noise_cells) + " is more than --cells " +
                     std::to_string(cells));
  if (const std::string formula = configuration.options().initial_formula; !formula.empty())
    request.formula =
        muparser::parse_formula(configuration.where(&config::RunOptions::initial_formula), formula);
  request.surface = surface_of(configuration);
  return request;
}

}  // namespace

FieldOnAnyMesh initial_field(const config::Configuration& configuration,
                             const problem::CahnHilliardModel& model) {
  const std::string kind = configuration.options().initial;
  const problem::InitialRequest request = initial_request(configuration, model);
  const auto option = kind == "formula" ? &config::RunOptions::initial_formula
                      : kind == "caps"  ? &config::RunOptions::initial_caps
                                        : &config::RunOptions::initial;
  return with_option_context(configuration, option, [&]() -> FieldOnAnyMesh {
    const auto [name, folder] = split_named_arguments(kind);
    if (name == "restart") {
      const auto earlier = std::make_shared<EarlierRun>(folder, configuration, model);
      return [&configuration, earlier, option](const fem::SurfaceSpace& space) {
        return with_option_context(configuration, option, [&] { return earlier->field_on(space); });
      };
    }
    (void)problem::initial_fields().find(name, {"restart:DIR"});
    return [&configuration, kind, request, option](const fem::SurfaceSpace& space) {
      return with_option_context(configuration, option,
                                 [&] { return problem::make_initial_field(kind, space, request); });
    };
  });
}

bool is_given_on_any_mesh(const config::Configuration& configuration) {
  const std::string name = split_named_arguments(configuration.options().initial).name;
  if (name == "restart") return true;
  for (const problem::InitialEntry& entry : problem::initial_fields())
    if (entry.name == name) return static_cast<bool>(entry.concentration);
  return false;
}

discs::StartingDiscs initial_discs(const config::Configuration& configuration,
                                   const problem::CahnHilliardModel& model) {
  const problem::InitialRequest request = basic_request(configuration, model);
  return with_option_context(configuration, &config::RunOptions::initial, [&] {
    const auto [name, arguments] = split_named_arguments(configuration.options().initial);
    if (name == "caps") {
      discs::StartingDiscs start;
      for (const problem::CapRaft& cap : request.caps)
        start.discs.push_back(
            {cap.direction.stableNormalized(), discs::area_of_half_angle(cap.angle)});
      return start;
    }
    if (name != "discs")
      throw InputError("the model of discs begins with rafts; choose discs or caps");
    const problem::InitialEntry& entry = problem::initial_fields().find(name);
    return problem::random_discs(
        request, parse_parameters("initial '" + name + "'", arguments, entry.parameters));
  });
}

}  // namespace traceraft::run
