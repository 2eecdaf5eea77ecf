#include "drivers/run/disc_run.hpp"

#include <algorithm>
#include <sstream>

#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/initial_state.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/progress.hpp"
#include "drivers/run/run_outputs.hpp"
#include "drivers/run/summary.hpp"
#include "drivers/text/say.hpp"
#include "drivers/version.hpp"
#include "kernel/core/text.hpp"
#include "kernel/observables/disc_observables.hpp"

namespace traceraft::run {
namespace {

constexpr double kMostCovered = 0.5;
// Pictures need no finer mesh.
constexpr std::int64_t kPictureCells = 64;

void refuse_other_physics(const config::Configuration& configuration,
                          const problem::CahnHilliardModel& model) {
  if (configuration.options().surface != "sphere")
    throw InputError(configuration.where(&config::RunOptions::surface) +
                     ": the model of discs is made for the sphere");
  if (!effects::has_unit_wells(model))
    throw InputError(configuration.where(&config::RunOptions::well) +
                     ": the model of discs needs wells at 0 and 1");
}

void refuse_covered(const config::Configuration& configuration,
                    const std::vector<discs::Disc>& discs) {
  double share = 0;
  for (const discs::Disc& disc : discs) share += disc.area / (4 * kPi);
  if (share > kMostCovered)
    throw InputError(configuration.where(&config::RunOptions::initial) +
                     formatted(": discs cover %.0f %% of the sphere (allowed: at most %.0f %%)",
                               100 * share, 100 * kMostCovered));
}

// One process works on it; the ground is a sphere without a mesh.
RunGround sphere() {
  return {{0, 0, 2}, 4 * kPi, 0, 1, 1};
}

class DiscRun {
 public:
  DiscRun(const config::Configuration& configuration, DiscSetup& run, const RunFolder& folder,
          const std::optional<Checkpoint>& checkpoint, bool quiet)
      : configuration_(configuration),
        run_(run),
        folder_(folder),
        store_(folder.checkpoints()),
        tables_(folder, run, checkpoint ? checkpoint->tables : TableExtents{}),
        before_(checkpoint ? checkpoint->cost : RunCost{}),
        progress_(run, quiet) {
    if (configuration.options().fields) {
      space_.emplace(surface_of(configuration),
                     std::min(kPictureCells, configuration.options().cells),
                     std::make_shared<ThreadTeam>(1), std::make_shared<SerialCommunicator>());
      files_.emplace(folder, run, run.system->model().well);
    }
    if (checkpoint)
      go_on_from(checkpoint->state);
    else
      begin();
  }

  simulation::RunResult advance() {
    const double interval = configuration_.options().checkpoint_interval;
    Stopwatch since_checkpoint;
    while (run_.system->state().t < run_.t_end) {
      if (posix::stop_requested()) return {simulation::RunEnd::stopped, ""};
      const double stop =
          next_output_ < run_.output_times.size() ? run_.output_times[next_output_] : run_.t_end;
      if (const Status status = run_.system->advance(stop); !status.ok())
        return {simulation::RunEnd::failed, status.why};
      const observables::Observables row = now();
      monitor_.accept(row);
      write_due_rows();
      add_step(row);
      progress_.show(row.t, run_.system->statistics().steps, run_.system->step(),
                     monitor_.mass_drift(), row.rafts);
      if (since_checkpoint.seconds() < interval) continue;
      write_checkpoint();
      since_checkpoint = Stopwatch();
    }
    return {simulation::RunEnd::finished, ""};
  }

  void finish(const simulation::RunResult& result, bool quiet) {
    progress_.finish();
    write_checkpoint();
    const observables::Observables row = now();
    const RunMoment end = moment(row, row.t * run_.units.time());
    const RunTotals totals{end, monitor_, sphere(), cost(), posix::peak_memory_mb()};
    input::write_json(folder_.summary(), summary_json(configuration_, totals, result, false,
                                                      tables_.extents_at_end(folder_)));
    if (quiet) return;
    const discs::DiscStatistics& statistics = run_.system->statistics();
    print_end(totals, result);
    print_line("energy", formatted("%.6g %s", row.energy * run_.units.area(),
                                   text::unit_name(text::Unit::area, run_.units.scaled).c_str()));
    print_line("rafts that",
               formatted("merged %lld, dissolved %lld", static_cast<long long>(statistics.merged),
                         static_cast<long long>(statistics.dissolved)));
    print_line("steps", formatted("%lld accepted, %lld rejected, %lld walks",
                                  static_cast<long long>(statistics.steps),
                                  static_cast<long long>(statistics.rejected),
                                  static_cast<long long>(statistics.walks)));
    print_cost(totals, folder_);
  }

 private:
  observables::Observables now() const {
    return observables::observe(*run_.system, run_.system->state());
  }
  RunMoment moment(const observables::Observables& row, double t) const {
    time::IntegratorStatistics steps;
    steps.steps = run_.system->statistics().steps;
    steps.rejected = run_.system->statistics().rejected;
    return {run_.units, row, t, run_.system->step(), steps, {}, 0};
  }
  RunCost cost() const {
    return {before_.wall_seconds + watch_.seconds(),
            before_.cpu_seconds + posix::thread_cpu_seconds() - cpu_at_start_};
  }

  void begin() {
    const observables::Observables row = now();
    monitor_.start(row, 4 * kPi, 4 * kPi * run_.system->model().well.energy(0.5));
    write_due_rows();
    add_step(row);
  }
  void go_on_from(const std::string& state) {
    std::istringstream saved(state);
    read_binary(saved, monitor_);
    read_binary(saved, next_output_);
    run_.system->load(saved);
  }
  void add_step(const observables::Observables& row) {
    tables_.add_step(moment(row, row.t * run_.units.time()));
  }

  void write_due_rows() {
    for (; next_output_ < run_.output_times.size() &&
           run_.output_times[next_output_] <= run_.system->state().t;
         ++next_output_) {
      const discs::DiscState& state = run_.system->state();  // steps end at output times
      tables_.add_output(
          moment(observables::observe(*run_.system, state), run_.output_labels[next_output_]),
          observables::raft_report(*run_.system, state));
      if (files_) write_fields(state);
    }
  }

  void write_fields(const discs::DiscState& state) const {
    const observables::DiscField field(*run_.system, state);
    SurfaceFields result{
        state.t, {{"c", Vec(static_cast<Eigen::Index>(space_->surface.position.size()))}}, {}};
    for (const Point& x : space_->surface.position) {
      result.fields[0].values[static_cast<Eigen::Index>(result.raft.size())] =
          field.concentration(x);
      result.raft.push_back(field.raft(x));
    }
    files_->write(*space_, result);
  }

  void write_checkpoint() {
    tables_.sync();
    Checkpoint checkpoint;
    checkpoint.configuration = identity_;
    StringAppender out(checkpoint.state);
    write_binary(out, monitor_);
    write_binary(out, next_output_);
    run_.system->save(out);
    checkpoint.step = static_cast<long>(run_.system->statistics().steps);
    checkpoint.cost = cost();
    checkpoint.tables = tables_.extents();
    store_.write(checkpoint);
  }

  const config::Configuration& configuration_;
  DiscSetup& run_;
  const RunFolder& folder_;
  const std::string identity_ = config::numerical_identity(configuration_);
  CheckpointStore store_;
  RunTables tables_;
  RunCost before_;
  Stopwatch watch_;
  double cpu_at_start_ = posix::thread_cpu_seconds();
  Progress progress_;
  std::optional<fem::SurfaceSpace> space_;  // of pictures
  std::optional<FieldFiles> files_;
  simulation::RunMonitor monitor_;
  std::size_t next_output_ = 0;
};

}  // namespace

DiscSetup build_disc_run(const config::Configuration& configuration) {
  DiscSetup run;
  static_cast<RunSchedule&>(run) = run_schedule(configuration);
  config::refuse_idle_options(configuration, {});
  if (backends::world()->size() > 1)
    throw InputError("--model: the model of discs runs on one rank");
  const problem::CahnHilliardModel model = model_without_effects(configuration);
  refuse_other_physics(configuration, model);
  const discs::DiscModel physics =
      with_option_context(configuration, &config::RunOptions::effect,
                          [&] { return effects::disc_model(model, effects_of(configuration)); });
  problem::CahnHilliardModel with_boundaries = model;
  with_boundaries.epsilon = physics.epsilon;
  const discs::StartingDiscs start = initial_discs(configuration, with_boundaries);
  refuse_covered(configuration, start.discs);
  run.system = std::make_unique<discs::DiscSystem>(physics, configuration.options().tolerance,
                                                   discs::start_state(physics, start));
  return run;
}

void print_disc_setup(const config::Configuration& configuration, const DiscSetup& run) {
  const physics::Units& units = run.units;
  const discs::DiscSystem& system = *run.system;
  text::say("traceraft %s\n", kVersion);
  print_line("case", configuration.options().case_name);
  print_line("model", formatted("discs on a sphere, R = %g um", units.radius_um));
  print_line("phase boundary",
             formatted("epsilon = %g um = %g R; discs below an area of %.3g %s dissolve",
                       system.model().epsilon * units.radius_um, system.model().epsilon,
                       system.phases().smallest_area() * units.area(),
                       text::unit_name(text::Unit::area, units.scaled).c_str()));
  print_physics(configuration, units);
  print_units(run);
  print_line("initial state",
             formatted("%zu discs, mean concentration %.6f, seed %lld", system.state().discs.size(),
                       system.state().mass / (4 * kPi),
                       static_cast<long long>(configuration.options().seed)));
}

simulation::RunResult execute_disc_run(const config::Configuration& configuration, DiscSetup& run,
                                       const RunFolder& folder,
                                       const std::optional<Checkpoint>& checkpoint, bool quiet) {
  DiscRun discs(configuration, run, folder, checkpoint, quiet);
  const simulation::RunResult result = discs.advance();
  discs.finish(result, quiet);
  return result;
}

simulation::RunResult carry_out_disc_run(const config::Configuration& configuration,
                                         const std::filesystem::path& path) {
  DiscSetup run = build_disc_run(configuration);
  const bool begun = std::filesystem::exists(path / "config.toml");
  const RunFolder folder =
      begun ? open_run_folder(path) : create_run_folder(path.string(), configuration);
  const std::optional<Checkpoint> checkpoint =
      last_checkpoint(path, config::numerical_identity(configuration));
  return execute_disc_run(configuration, run, folder, checkpoint, true);
}

}  // namespace traceraft::run
