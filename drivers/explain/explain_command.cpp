#include <CLI/CLI.hpp>
#include <cstdio>
#include <thread>

#include "backends/posix/folder_lock.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/field_dataset.hpp"
#include "drivers/input/measured_units.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct ExplainCommand {
  GivenValues flags;
  std::string data, model, out;
  int threads = 0, effects = 3, replicates = 199;
  bool quiet = false;
};

// The options of the model, those on the command line first, with the radius of the vesicle.
GivenValues given_model(const ExplainCommand& command, double radius_um) {
  GivenValues given = read_config_file(command.model);
  for (const auto& [name, value] : command.flags) given[name] = value;
  given["radius"] = {format_number(radius_um), "dataset.toml: radius"};
  return given;
}

void refuse_model(const Configuration& model) {
  refuse_scaled(model);
  if (!model.text("effect").empty())
    throw InputError(model.where("effect") +
                     ": the search starts from a model without effects; it finds them itself");
}

int explain(const ExplainCommand& command) {
  if (command.data.empty()) throw InputError("--data: say which measurements to explain");
  FieldDataset data = read_field_dataset(command.data);
  if (data.vesicles.size() > 1)
    throw InputError("--data: " + command.data +
                     " holds several vesicles; explain them one at a time");
  const GivenValues given = given_model(command, data.radius_um);
  const Configuration model(given, {});
  refuse_model(model);

  ExplainRequest request;
  request.base = physical_model(model);
  request.surface = surface_of(model);
  request.cells = static_cast<int>(model.integer("cells"));
  request.threads = command.threads > 0
                        ? command.threads
                        : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  request.most_effects = command.effects;
  request.filter.replicates = command.replicates;
  const Stopwatch watch;
  if (!command.quiet)
    request.progress = [&](const std::string& step) {
      std::printf("%s  %s\n", clock_text(watch.seconds()).c_str(), step.c_str());
      std::fflush(stdout);
    };
  FieldSeries& series = data.vesicles.front();
  for (FieldSnapshot& snapshot : series.snapshots) snapshot.time /= model.units().time();

  const fs::path out = command.out.empty() ? first_free_folder("explain") : command.out;
  fs::create_directories(out);
  const FolderLock lock(out);
  const Explanation found = explain_fields(series, request);
  write_explanation(out, found, given);
  if (!command.quiet) {
    print_explanation(found, given);
    std::printf("\nwritten: %s\n", (out / "verdict.json").c_str());
  }
  return kSuccess;
}

Action define(CLI::App& app) {
  const auto command = std::make_shared<ExplainCommand>();
  app.add_option("--data", command->data,
                 "folder of measured fields (dataset.toml, snapshot_001.csv, ...)");
  app.add_option("--model", command->model, "TOML file with the flags' names as keys");
  app.add_option("--out", command->out, "folder for the verdict; default: runs/explain-N");
  app.add_option("--effects", command->effects, "most effects to look for, one after the other")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
  app.add_option("--replicates", command->replicates,
                 "of noise alone, that what is found is judged by")
      ->check(CLI::Range(49, 9999))
      ->capture_default_str();
  app.add_option("--threads", command->threads, "default: one for each processor")
      ->check(CLI::Range(1, 256));
  app.add_flag("--quiet", command->quiet, "print nothing but errors");
  add_options(app, command->flags, [](const OptionSpec& spec) {
    return (spec.group == "Physics" || spec.group == "Surface" || spec.group == "Case") &&
           spec.name != "radius" && spec.name != "scaled" && spec.name != "effect";
  });
  app.footer("Example: traceraft explain --data my-vesicle --model model.toml --cells 40");
  return [command] { return explain(*command); };
}

}  // namespace

Command explain_command() {
  return {"explain", "find what the model is missing, from measured fields", Ranks::one, define};
}

}  // namespace traceraft
