#include "drivers/explain/explain_run.hpp"

#include <thread>

#include "drivers/config/config_file.hpp"
#include "drivers/input/field_dataset.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/effects/effects.hpp"

namespace traceraft {
namespace {

GivenValues given_model(const ExplainJob& job, double radius_um) {
  GivenValues given = read_config_file(job.model, "--model");
  for (const auto& [name, value] : job.flags) given[name] = value;
  given["radius"] = {format_number(radius_um), "dataset.toml: radius"};
  return given;
}

}  // namespace

int ExplainJob::processors() const {
  return threads > 0 ? threads
                     : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

void refuse_effects(const Configuration& model) {
  if (!model.text("effect").empty())
    throw InputError(model.where("effect") +
                     ": the search starts from a model without effects; it finds them itself");
}

ExplainSetup read_explain_job(const ExplainJob& job) {
  FieldDataset data = read_field_dataset(job.data);
  ExplainSetup setup{given_model(job, data.radius_um), std::move(data.vesicles), {}};
  const Configuration model(setup.model, {});
  refuse_scaled(model);
  refuse_effects(model);
  for (FieldSeries& vesicle : setup.series)
    for (FieldSnapshot& snapshot : vesicle.snapshots) snapshot.time /= model.units().time();

  ExplainRequest& request = setup.request;
  request.base = physical_model(model);
  request.surface = surface_of(model);
  request.cells = static_cast<int>(model.integer("cells"));
  request.threads = job.processors();
  request.most_effects = job.effects;
  request.without = job.without;
  request.filter.replicates = job.replicates;
  return setup;
}

}  // namespace traceraft
