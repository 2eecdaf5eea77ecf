#include <CLI/CLI.hpp>
#include <algorithm>

#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/configuration.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/data/comparison_report.hpp"
#include "drivers/data/field_report.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/ensemble/ensemble_folder.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/input/facts_file.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::data {
namespace {

namespace fs = std::filesystem;

struct DataRequest {
  std::string action, folder, ensemble, out, facts, window = "100,1000";
  std::int64_t seed = 1;
  bool quiet = false;
};

statistics::Window window_of(const std::string& text) {
  const std::vector<std::string> ends = config::split_list(text);
  if (ends.size() != 2) throw InputError("--window: two times are needed, as in 100,1000");
  const statistics::Window window{parse_number("--window", ends[0]),
                                  parse_number("--window", ends[1])};
  if (!(window.begin >= 0)) throw InputError("--window: a time cannot be negative");
  if (!(window.end > window.begin))
    throw InputError("--window: the second time must be later than the first");
  return window;
}

int check(const DataRequest& request) {
  if (input::holds_fields(request.folder)) {
    const input::FieldDataset fields = input::read_field_dataset(request.folder);
    if (!request.quiet) print_fields(request.folder, fields);
    if (!input::holds_series(request.folder)) return drivers::kSuccess;
  }
  const observations::MeasuredVesicles data = input::read_dataset(request.folder);
  const statistics::Window window = window_of(request.window);
  if (!request.quiet) print_dataset(data, observations::fit_measurements(data, window), window);
  return drivers::kSuccess;
}

int compare(const DataRequest& request) {
  if (request.ensemble.empty())
    throw InputError(
        "--ensemble: the folder of an ensemble is needed (traceraft ensemble writes it)");
  fs::path out = request.out;
  if (out.empty())
    out = ensemble::EnsembleFolder(request.ensemble).started()
              ? request.ensemble
              : run::first_free_folder("comparison");
  if (!ensemble::EnsembleFolder(out).started())
    run::refuse_foreign_folder(out, {"comparison.json"});
  const std::string command =
      "traceraft data compare " + text::in_shell(request.folder) + " --ensemble " +
      text::in_shell(request.ensemble) + " --window " + text::in_shell(request.window) +
      (request.facts.empty() ? "" : " --facts " + text::in_shell(request.facts));
  ComparisonRequest comparison{request.ensemble,          out,          command,
                               window_of(request.window), std::nullopt, request.quiet};
  if (!request.facts.empty()) comparison.facts = input::read_facts(request.facts);
  return compare_with_ensemble(input::read_dataset(request.folder), comparison);
}

// Refuses to write over data.
int draw(const DataRequest& request) {
  if (request.facts.empty()) throw InputError("--facts: a file of published facts is needed");
  const fs::path folder = request.folder;
  if (fs::exists(folder / "dataset.toml") || fs::exists(folder / "measurements.csv"))
    throw InputError(request.folder + " already holds data; choose another folder");
  const observations::PublishedFacts facts = input::read_facts(request.facts);
  const auto seed = static_cast<std::uint64_t>(request.seed);
  const observations::MeasuredVesicles data =
      request.ensemble.empty()
          ? observations::draw_measurements(facts, seed)
          : observations::draw_from_runs(facts, runs_of(request.ensemble).histories,
                                         model_of(request.ensemble).units().length(), seed);
  input::write_dataset(request.folder, data,
                       std::string("SYNTHETIC: drawn from ") +
                           (request.ensemble.empty() ? "published facts" : "simulations") +
                           ", not measured (seed " + std::to_string(request.seed) + ")");
  if (!request.quiet)
    text::say("%zu synthetic measurements in %s\n", data.measurements.size(), request.folder);
  return drivers::kSuccess;
}

struct DataAction {
  std::string name;
  int (*run)(const DataRequest&);
  std::vector<std::string> options;  // that it uses, of those that not all use
};
const NamedList<DataAction>& actions() {
  static const NamedList<DataAction> list(
      "action", {{"check", check, {"--window"}},
                 {"compare", compare, {"--ensemble", "--facts", "--out", "--window"}},
                 {"draw", draw, {"--ensemble", "--facts", "--seed"}}});
  return list;
}

// Refuses options that would do nothing: they were meant to do something.
void refuse_unused(const CLI::App& app, const DataAction& action) {
  for (const char* option : {"--ensemble", "--facts", "--out", "--seed", "--window"})
    if (app.count(option) > 0 &&
        std::find(action.options.begin(), action.options.end(), option) == action.options.end())
      throw InputError(std::string(option) + ": data " + action.name +
                       " does not use it (it uses " + joined(action.options, ", ") + ")");
}

drivers::Action define_data(CLI::App& app) {
  const auto request = std::make_shared<DataRequest>();
  app.add_option("action", request->action,
                 "check (read a folder of measurements and describe it), compare (compare an "
                 "ensemble with it) or draw (write synthetic measurements from published facts)")
      ->type_name(joined(actions().names(), "|"))
      ->required();
  app.add_option("folder", request->folder, "folder of the measurements (dataset.toml)")
      ->type_name("DIR")
      ->required();
  app.add_option("--ensemble", request->ensemble,
                 "folder of the ensemble to compare with, or to draw from")
      ->type_name("DIR");
  app.add_option("--out", request->out,
                 "folder for the comparison; default: the folder of the ensemble, or "
                 "runs/comparison-<number> for kept histories")
      ->type_name("DIR");
  app.add_option("--window", request->window,
                 "first and last time of the points that a power law is fitted to (s)")
      ->type_name("NUMBER,NUMBER")
      ->capture_default_str();
  app.add_option("--facts", request->facts,
                 "TOML file of published facts, to draw from or to show in a comparison")
      ->type_name("FILE");
  app.add_option("--seed", request->seed, "seed of the synthetic measurements")
      ->check(config::between(0, config::kLargestSeed))
      ->capture_default_str();
  app.add_flag("--quiet", request->quiet, "print errors only");
  app.footer(
      "Example: traceraft data compare my-vesicles --ensemble "
      "verification/data/ensembles/guv-3to1");
  return [request, &app] {
    const DataAction& action = actions().find(request->action);
    refuse_unused(app, action);
    return action.run(*request);
  };
}

}  // namespace

drivers::Command data_command() {
  return {"data", "check measurements of vesicles and compare simulations with them",
          drivers::Ranks::one, define_data};
}

}  // namespace traceraft::data
