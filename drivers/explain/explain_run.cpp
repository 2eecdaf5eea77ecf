#include "drivers/explain/explain_run.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "drivers/config/config_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/field_dataset.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/physical_model.hpp"
#include "drivers/run/run_mesh.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

config::GivenValues with_radius(config::GivenValues model, double radius_um) {
  model["radius"] = {format_number(radius_um), "dataset.toml: radius"};
  return model;
}

// Notes on a model that says another radius than the data, and on data that are not where they say.
std::vector<std::string> notes_on(const config::GivenValues& model,
                                  const input::FieldDataset& data) {
  std::vector<std::string> notes;
  const config::Configuration configuration(model, {});
  if (model.count("radius") > 0) {
    const double own = configuration.options().radius;
    if (std::fabs(own - data.radius_um) > 1e-6 * data.radius_um)
      notes.push_back("The radius is that of dataset.toml, " + format_number(data.radius_um) +
                      " um, instead of that of the model, " + format_number(own) + ".");
  }
  if (const std::string note = input::note_on_distance(data);
      !note.empty() && configuration.options().surface == "sphere")
    notes.push_back(note);
  return notes;
}

// Only spheres are simple enough to say where before the mesh is there.
void refuse_points_off_the_sphere(const input::FieldDataset& data, const std::string& folder) {
  std::size_t number = 0;
  for (const assimilation::FieldSeries& vesicle : data.vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      ++number;
      for (std::size_t i = 0; i < snapshot.points.size(); ++i) {
        const Point x = data.radius_um * snapshot.points[i];
        const double distance = snapshot.points[i].norm() - 1;
        if (std::fabs(distance) <= assimilation::kOffSurface) continue;
        throw InputError(
            input::place_of(folder, number, i, "") +
            formatted(": (%.4g, %.4g, %.4g) um is %.2g R away from the sphere (allowed: %g R). Are "
                      "radius and length_unit right, and is the centre at 0?",
                      x[0], x[1], x[2], std::fabs(distance), assimilation::kOffSurface));
      }
    }
}

// Missing values that somebody has coded as numbers, and c on another scale.
void refuse_far_values(const std::vector<assimilation::FieldSeries>& vesicles,
                       const physics::DoubleWell& well, const std::string& folder) {
  const double width = well.b - well.a;
  std::size_t number = 0;
  for (const assimilation::FieldSeries& vesicle : vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      ++number;
      for (Eigen::Index i = 0; i < snapshot.values.size(); ++i) {
        const double c = snapshot.values[i];
        if (c >= well.a - input::kFarFromWells * width &&
            c <= well.b + input::kFarFromWells * width)
          continue;
        throw InputError(input::place_of(folder, number, static_cast<std::size_t>(i), "c") + ": " +
                         formatted("%.6g", c) + " is far from the phases of the model, " +
                         format_number(well.a) + " and " + format_number(well.b) +
                         "; leave out missing values, and scale c so that the phases agree");
      }
    }
}

// Most likely the radius or the unit of length is not what it is said to be.
void refuse_wide_boundaries(const config::Configuration& model,
                            const problem::CahnHilliardModel& base) {
  constexpr double kWidest = 0.5;
  if (base.epsilon > kWidest)
    throw InputError(model.where(&config::RunOptions::epsilon) + ": " +
                     format_number(model.options().epsilon) +
                     " um is more than half of the radius, " +
                     format_number(model.units().radius_um) + " um by dataset.toml");
}

// Nothing moves in what is the same everywhere, and no measurement is without noise.
void refuse_uniform_values(const std::vector<assimilation::FieldSeries>& vesicles,
                           const physics::DoubleWell& well, const std::string& folder) {
  constexpr double kLeast = 1e-6;
  std::size_t number = 0;
  for (const assimilation::FieldSeries& vesicle : vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      ++number;
      if (snapshot.values.maxCoeff() - snapshot.values.minCoeff() > kLeast * (well.b - well.a))
        continue;
      throw InputError((fs::path(folder) / input::snapshot_file(number)).string() + ": c is " +
                       format_number(snapshot.values[0]) +
                       " everywhere, which explains nothing; leave this snapshot out");
    }
}

// A dye of the other phase. The equation is the same for c and 1 − c, so that no fit would tell.
void refuse_exchanged_phases(const config::Configuration& model,
                             const std::vector<assimilation::FieldSeries>& vesicles,
                             const physics::DoubleWell& well) {
  constexpr double kTold = 0.2, kMuchNearer = 4;
  const double stated = model.options().raft_fraction;
  if (model.options().initial != "noise" || std::fabs(1 - 2 * stated) < kTold) return;
  double sum = 0, count = 0;
  for (const assimilation::FieldSeries& vesicle : vesicles)
    for (const assimilation::FieldSnapshot& snapshot : vesicle.snapshots) {
      sum += snapshot.values.sum();
      count += static_cast<double>(snapshot.values.size());
    }
  const double measured = (sum / count - well.a) / (well.b - well.a);
  if (kMuchNearer * std::fabs(measured - (1 - stated)) > std::fabs(measured - stated)) return;
  throw InputError(
      model.where(&config::RunOptions::raft_fraction) + ": the model has " + format_number(stated) +
      formatted(" of rafts, but the mean of c is %.2f; if c marks the other phase, ", measured) +
      formatted("write 1 - c; otherwise give --raft-fraction %.2f", measured));
}

// The effects of the model itself. One whose strength no data determine, or that is excluded by
// --without, is refused.
assimilation::Hypothesis own_effects(const config::Configuration& model,
                                     const std::vector<assimilation::Candidate>& asked,
                                     const std::vector<std::string>& without) {
  const assimilation::Hypothesis own =
      run::with_option_context(model, &config::RunOptions::effect, [&] {
        const problem::CahnHilliardModel base = run::model_without_effects(model);
        std::vector<effects::EffectTerm> terms;
        for (const effects::EffectTerm& term : run::effects_of(model))
          for (const effects::EffectTerm& single :
               effects::in_single_strengths(term, base.epsilon, base.well))
            terms.push_back(single);
        return assimilation::of_model(terms);
      });
  for (const assimilation::Hypothesis::Part& part : own.parts) {
    const std::string& name = part.candidate.name;
    if (std::count(without.begin(), without.end(), name) > 0)
      throw InputError("--without: the model has " + name +
                       ", and fits its strength; remove it from the model instead");
    if (std::none_of(asked.begin(), asked.end(),
                     [&](const assimilation::Candidate& c) { return c.name == name; }))
      throw InputError(model.where(&config::RunOptions::effect) + ": effect " + name +
                       " does almost nothing on this surface, so that no data determine its "
                       "strength; leave it out");
  }
  return own;
}

// Throws InputError if there is nothing to look for.
void set_effects(const config::Configuration& model, ExplainSetup& setup) {
  selection::ExplainRequest& request = setup.request;
  const std::vector<Point>& places = setup.series.front().snapshots.front().points;
  const std::vector<assimilation::Candidate> asked =
      assimilation::candidates_for(request.base, *request.surface, places, request.without);
  request.own = own_effects(model, asked, request.without);
  if (assimilation::candidates_beside(request.own, asked).empty())
    throw InputError("--without: no effect is left to search for");
  for (const assimilation::Candidate& candidate : asked)
    for (const assimilation::Hypothesis::Part& part : request.own.parts)
      if (assimilation::are_one(candidate, part.candidate))
        setup.notes.push_back(candidate.name + " is left out of the search: the model's " +
                              part.candidate.name + " is another form of it.");
}

}  // namespace

int ExplainJob::processors() const {
  return threads > 0 ? threads
                     : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

double ExplainSetup::last_s() const {
  double last = 0;
  for (const assimilation::FieldSeries& vesicle : series)
    last = std::max(last, vesicle.snapshots.back().time);
  return last * configuration.units().time();
}

std::string data_text(const ExplainSetup& setup) {
  std::size_t snapshots = 0;
  for (const assimilation::FieldSeries& vesicle : setup.series)
    snapshots += vesicle.snapshots.size();
  const std::size_t vesicles = setup.series.size();
  const double radius = setup.configuration.units().length();
  const double blur = setup.request.filter.blur * radius;
  return setup.name + (setup.synthetic ? " (SYNTHETIC): " : ": ") + std::to_string(vesicles) +
         (vesicles == 1 ? " vesicle, " : " vesicles, ") + std::to_string(snapshots) +
         formatted(" snapshots, R = %g um, ", radius) +
         (!setup.request.blur_stated ? "blur not stated"
          : blur > 0                 ? formatted("blurred by %g um", blur)
                                     : "not blurred");
}

config::GivenValues model_said(const ExplainJob& job) {
  config::GivenValues said = job.flags;
  said.merge(config::read_config_file(job.model, "--model"));
  said.merge(config::uniform_mesh());
  return said;
}

ExplainSetup read_explain_job(const ExplainJob& job) {
  input::FieldDataset data = input::read_field_dataset(job.data);
  // A width of the boundaries says that a model is meant; other values may be those of any.
  if (job.flags.count("epsilon") == 0)
    input::refuse_without_model(data.composition, job.model, job.flags);
  const config::GivenValues said = model_said(job);
  ExplainSetup setup;
  setup.model_file = job.model;
  setup.model = with_radius(said, data.radius_um);
  setup.notes = notes_on(said, data);
  setup.name = data.name;
  setup.synthetic = data.synthetic;
  const config::Configuration& model = setup.configuration = config::Configuration(setup.model, {});
  input::refuse_scaled(model);
  run::refuse_discs(model);
  run::refuse_adaptive_mesh(model);
  (void)run::physical_model(model);  // with its effects it has to be one
  setup.request.base = run::model_without_effects(model);
  const physics::DoubleWell& well = setup.request.base.well;
  if (model.options().surface == "sphere") refuse_points_off_the_sphere(data, job.data);
  if (const std::string note = input::note_on_scale(data, well.a, well.b); !note.empty())
    setup.notes.push_back(note);
  setup.series = std::move(data.vesicles);
  if (const std::string other = input::other_membrane(data.composition, model); !other.empty())
    setup.notes.push_back("ANOTHER MEMBRANE: the membrane of the model is " + other + ".");
  for (assimilation::FieldSeries& vesicle : setup.series)
    for (assimilation::FieldSnapshot& snapshot : vesicle.snapshots)
      snapshot.time /= model.units().time();

  selection::ExplainRequest& request = setup.request;
  request.surface = run::surface_of(model);
  request.cells = static_cast<int>(model.options().cells);
  request.threads = job.processors();
  request.most_effects = job.effects;
  request.without = job.without;
  request.filter.replicates = job.replicates;
  if (job.diffusion_error > 0) request.filter.diffusion_ratio_doubt = job.diffusion_error;
  request.filter.blur = data.blur_um.value_or(0) / data.radius_um;
  request.blur_stated = data.blur_um.has_value();
  if (data.noise_share > 0)
    request.filter.correlation = assimilation::gaussian_correlation(
        data.noise_correlation_um / data.radius_um, data.noise_share);
  refuse_wide_boundaries(model, request.base);
  refuse_far_values(setup.series, request.base.well, job.data);
  refuse_uniform_values(setup.series, request.base.well, job.data);
  refuse_exchanged_phases(model, setup.series, request.base.well);
  set_effects(model, setup);
  return setup;
}

}  // namespace traceraft::explain
