#include "drivers/run/summary.hpp"

#include <nlohmann/json.hpp>

#include "backends/posix/process.hpp"
#include "backends/suitesparse/blas.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/program.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/progress.hpp"
#include "drivers/run/run_numbers.hpp"
#include "drivers/text/say.hpp"
#include "drivers/text/unit_names.hpp"
#include "drivers/version.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::run {
namespace {

const char* end_name(simulation::RunEnd end) {
  switch (end) {
    case simulation::RunEnd::finished:
      return "finished";
    case simulation::RunEnd::stopped:
      return "stopped";
    default:
      return "failed";
  }
}

// The energy, and what became of steps that gained some.
std::string energy_text(const config::Configuration& configuration, const RunSetup& run,
                        const simulation::RunState& state) {
  const std::string energy = formatted("%.6g %s", state.observables.energy * run.units.area(),
                                       text::unit_name(text::Unit::area, run.units.scaled).c_str());
  if (!run.problem->dissipates_energy()) return energy + " (the energy may grow in this model)";
  if (configuration.options().energy_guard == "off") return energy;
  const long refused = run.integrator->statistics().energy_rises;
  const std::string cut =
      refused > 0 ? formatted(", %ld steps shortened because it grew", refused) : "";
  if (state.monitor.energy_rises() == 0) return energy + ", falls in every step" + cut;
  return energy +
         formatted(", GROWS in %ld steps, by at most %.0e of the initial energy;",
                   state.monitor.energy_rises(), state.monitor.largest_rise()) +
         " a smaller --tolerance or --energy-guard reject prevents that";
}

void put(nlohmann::ordered_json& json, const char* name, text::Unit unit, double value) {
  if (unit == text::Unit::count) {
    json[name] = static_cast<std::int64_t>(value);
  } else {
    json[name] = value;
  }
}

}  // namespace

int exit_code(const simulation::RunResult& result) {
  switch (result.end) {
    case simulation::RunEnd::finished:
      return drivers::kSuccess;
    case simulation::RunEnd::stopped:
      return drivers::kInterrupted;
    default:
      return drivers::kNumericalFailure;
  }
}

void print_line(const char* label, const std::string& value) {
  text::say("  %-22s %s\n", label, value);
}

void print_end(const RunTotals& totals, const simulation::RunResult& result) {
  const observables::Observables& row = totals.at.observables;
  const physics::Units& units = totals.at.units;
  const std::string length = text::unit_name(text::Unit::length, units.scaled);
  text::say("\n%s at t = %.6g%s\n", end_name(result.end), totals.at.t, units.scaled ? "" : " s");
  if (!result.why.empty()) print_line("why", result.why);
  print_line("rafts", formatted("%d", row.rafts) +
                          (row.raft_fraction > 0.5
                               ? formatted(", around %d domains of the other phase", row.domains)
                               : ""));
  print_line("raft fraction", formatted("%.4f of the area, mean concentration %.6f",
                                        row.raft_fraction, row.mass / totals.ground.area));
  print_line("perimeter",
             formatted("%.5g %s (level curve %.5g %s)", row.perimeter * units.length(),
                       length.c_str(), row.perimeter_level * units.length(), length.c_str()));
}

void print_cost(const RunTotals& totals, const RunFolder& folder) {
  print_line("time",
             formatted("%s wall, %s CPU, peak memory %.0f MB",
                       output::clock_text(totals.cost.wall_seconds).c_str(),
                       output::clock_text(totals.cost.cpu_seconds).c_str(), totals.memory_mb));
  print_line("tables", folder.table("series.csv").string());
  if (!std::filesystem::exists(folder.path / "view.png")) return;
  print_line("open next", (folder.path / "view.png").string() +
                              " (front and back at the latest output time; rafts are yellow)");
  print_line("or", "paraview " + text::in_shell((folder.path / "fields.pvd").string()));
  print_line("or", "traceraft report " + text::in_shell(folder.path.string()) +
                       " (writes a page with charts)");
}

std::string configuration_checksum(const config::Configuration& configuration) {
  return formatted("%08x", zlib::crc32_of(config::numerical_identity(configuration)));
}

input::Json summary_json(const config::Configuration& configuration, const RunTotals& totals,
                         const simulation::RunResult& result, bool decay_promised,
                         const TableExtents& tables) {
  const physics::Units& units = totals.at.units;
  input::Json json;
  json["end"] = end_name(result.end);
  if (!result.why.empty()) json["why"] = result.why;
  json["version"] = kVersion;
  json["build"] = output::program_checksum();
  json["model"] = configuration.options().model;
  json["case"] = configuration.options().case_name;
  json["effects"] = configuration.options().effect;
  json[kConfiguration] = configuration_checksum(configuration);
  json["seed"] = configuration.options().seed;
  json["integrator"] = configuration.options().integrator;
  json["linear_solver"] = configuration.options().linear_solver;
  json["units"] = {{"scaled", units.scaled},
                   {"radius_um", units.radius_um},
                   {"diffusion_cm2_s", units.diffusion_cm2_s},
                   {"seconds_per_unit", units.seconds_per_unit()}};
  json["energy_guard"] = configuration.options().energy_guard;
  json["energy_decay_promised"] = decay_promised;
  for (const auto& column : run_columns())
    put(json, column.name, column.unit, column.value(totals.at));
  for (const auto& total : run_totals()) put(json, total.name, total.unit, total.value(totals));
  json["blas"] = suitesparse::blas_description();
  for (const auto& [name, extent] : tables)
    json["tables"][name] = {{"bytes", extent.bytes}, {"crc32", formatted("%08x", extent.checksum)}};
  return json;
}

// Nothing separates on a sphere where f0'' + ε² l(l + 1)/R² > 0 even for c halfway and l = 1. Other
// surfaces are longer than wide: l(l + 1)/R² is taken as half of that.
bool is_as_wide_as(const std::string& surface, const problem::CahnHilliardModel& model) {
  const double stiffness = (surface == "sphere" ? 2 : 1) * model.epsilon * model.epsilon;
  return stiffness > -model.well.second(0.5 * (model.well.a + model.well.b));
}

std::string resolution_text(const config::Configuration& configuration, const RunSetup& run) {
  constexpr double kCoarse = 4;  // h/epsilon beyond which the mesh shapes the boundaries
  const problem::CahnHilliardModel& model = run.problem->model();
  const double epsilon = model.epsilon, ratio = run.space->h() / epsilon;
  return formatted(
      "epsilon = %g um = %g R, h/epsilon = %.2f, %.1f %% of its gradient energy resolved%s",
      epsilon * run.units.radius_um, epsilon, ratio, 100 * run.boundary.resolved,
      is_as_wide_as(configuration.options().surface, model)
          ? "; TOO WIDE FOR THE VESICLE: choose a smaller --epsilon"
      : ratio > kCoarse ? "; TOO COARSE: choose more --cells"
                        : "");
}

// The length of the noise decides how many rafts survive (docs/guide.md).
std::string initial_text(const config::Configuration& configuration, const RunSetup& run) {
  const std::string kind = configuration.options().initial;
  if (kind != "noise") return kind;
  const double length = configuration.noise_length();  // in the units of the outputs
  return formatted("noise of %.3g %s = %.3g epsilon", length,
                   text::unit_name(text::Unit::length, run.units.scaled).c_str(),
                   length / (run.problem->model().epsilon * run.units.length()));
}

std::string repeated_times_text(const RunSetup& run) {
  std::vector<std::string> repeated;
  for (const double label : run.repeated_labels) repeated.push_back(format_number(label));
  return std::to_string(run.output_times.size()) +
         "; given more than once: " + joined(repeated, ", ");
}

void print_physics(const config::Configuration& configuration, const physics::Units& units) {
  print_line("mobility", formatted("%s, D = %g cm^2/s", configuration.options().mobility.c_str(),
                                   units.diffusion_cm2_s));
  if (configuration.options().effect.empty()) return;
  print_line("effects", configuration.options().effect);
  for (const auto& [effect, text] : effects::descriptions(
           effects_of(configuration), model_without_effects(configuration), units))
    print_line(effect.c_str(), text);
}

void print_units(const RunSchedule& run) {
  const physics::Units& units = run.units;
  print_line("units",
             formatted("length R = %g um, time R^2/D = %g s; the run ends at %g s = %g R^2/D",
                       units.radius_um, units.seconds_per_unit(),
                       run.t_end * units.seconds_per_unit(), run.t_end));
}

std::string sizes_text(const RunSetup& run) {
  if (!run.adaptation) return "";
  return formatted(" and, away from boundaries, down to %lld",
                   static_cast<long long>(run.adaptation->forest().levels().coarsest_cells()));
}

void print_setup(const config::Configuration& configuration, const RunSetup& run) {
  const physics::Units& units = run.units;
  text::say("traceraft %s\n", kVersion);
  print_line("case", configuration.options().case_name);
  print_line("surface",
             formatted("%s, R = %g um, area %.6g %s", configuration.options().surface.c_str(),
                       units.radius_um, run.space->area * units.area(),
                       text::unit_name(text::Unit::area, units.scaled).c_str()));
  const fem::SurfaceSpace::Totals& totals = run.space->totals;
  print_line(
      "mesh",
      formatted("%lld cells per edge%s, %lld cut tetrahedra, %lld nodes, %lld unknowns",
                configuration.options().cells, sizes_text(run).c_str(),
                static_cast<long long>(totals.elements), static_cast<long long>(totals.nodes),
                static_cast<long long>(2 * totals.nodes)));
  print_line("phase boundary", resolution_text(configuration, run));
  print_physics(configuration, units);
  if (const double longest = run.problem->longest_step(); longest < run.t_end)
    print_line("steps", formatted("at least %.0f: the effects allow steps up to %g %s",
                                  std::ceil(run.t_end / longest), longest * units.time(),
                                  text::unit_name(text::Unit::time, units.scaled).c_str()));
  print_units(run);
  if (!run.repeated_labels.empty()) print_line("output times", repeated_times_text(run));
  if (run.initial.size() > 0)
    print_line("initial state", formatted("%s, mean concentration %.6f, seed %lld",
                                          initial_text(configuration, run).c_str(),
                                          run.initial_mean, configuration.options().seed));
  const int workers = run.ranks->size() > 1 ? run.ranks->size() : run.team->size();
  print_line(
      "method",
      formatted("%s with %s, tolerance %g, %d %s%s, %s", configuration.options().integrator.c_str(),
                configuration.options().linear_solver.c_str(), configuration.options().tolerance,
                workers, run.ranks->size() > 1 ? "rank" : "thread", workers == 1 ? "" : "s",
                suitesparse::blas_description().c_str()));
}

std::string meshes_text(const simulation::RemeshStatistics& meshes) {
  return formatted("%ld changes, %.0f nodes in the mean of the steps, energy %+.1e to %+.1e in one",
                   meshes.remeshes, meshes.mean_nodes(), meshes.lowest_jump, meshes.highest_jump);
}

void print_summary(const config::Configuration& configuration, const RunSetup& run,
                   const simulation::RunState& state, const simulation::RunResult& result,
                   const RunCost& cost, double memory_mb, const RunFolder& folder) {
  const observables::Observables& row = state.observables;
  const time::IntegratorStatistics steps = run.integrator->statistics();
  const linear::LinearStatistics linear = run.integrator->linear_statistics();
  const RunMoment end = moment_of(run, row, row.t * run.units.time());
  const RunTotals totals{end, state.monitor, ground_of(run), cost, memory_mb};
  print_end(totals, result);
  print_line("energy", energy_text(configuration, run, state));
  print_line(
      "mass drift",
      formatted("%.1e relative%s", state.monitor.mass_drift(),
                run.problem->conserves_mass() ? "" : " (the mass may change in this model)"));
  print_line("c on the surface", formatted("%.3f to %.3f", row.c_min, row.c_max));
  const std::string first_order =
      steps.first_order > 0 ? formatted(" (%ld with the first-order solution)", steps.first_order)
                            : "";
  print_line("steps", formatted("%ld accepted", steps.steps) + first_order +
                          formatted(", %ld rejected (error too large), %ld failed (not solved)",
                                    steps.rejected, steps.failures));
  if (run.adaptation) print_line("meshes", meshes_text(run.adaptation->statistics()));
  if (steps.newton_iterations > 0)
    print_line("Newton iterations",
               formatted("%ld, order of the last step %d", steps.newton_iterations, steps.order));
  print_line(
      "linear solves",
      formatted(
          "%ld, %.1f iterations each, %ld set-ups, %ld renewed, %ld fallbacks", linear.solves,
          static_cast<double>(linear.iterations) / static_cast<double>(std::max(1L, linear.solves)),
          linear.setups, steps.renewals, steps.fallbacks));
  print_cost(totals, folder);
}

}  // namespace traceraft::run
