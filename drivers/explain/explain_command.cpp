#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/data/measured_report.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/explain/explain_page.hpp"
#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/resumable_search.hpp"
#include "drivers/explain/series_report.hpp"
#include "drivers/explain/series_verdict.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/input/measured_folder.hpp"
#include "drivers/input/model_of_data.hpp"
#include "drivers/numerical_failure.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/checked_options.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

// Series are explained with D within this factor of the model's, if nothing else is known of it.
constexpr double kTimeRange = 8;
// The same of discs: where the membrane flows rafts meet by themselves, and D may be that of
// lipids.
constexpr double kTimeRangeOfDiscs = 1000;
// Seeds for series, of the model and of each effect.
constexpr int kRuns = 8, kRunsOfDiscs = 64;
constexpr double kZeroCelsius = 273.15, kRoomCelsius = 25;

likelihood::UnitPrior unit_range(const config::Configuration& model, double diffusion_error) {
  constexpr double kReach = 2;
  const double seconds = model.units().seconds_per_unit();
  if (diffusion_error > 0)
    return likelihood::UnitPrior::within_factor(
        seconds, std::exp(statistics::kNormal95 * diffusion_error), kReach);
  return likelihood::UnitPrior::within_factor(
      seconds, run::is_of_discs(model) ? kTimeRangeOfDiscs : kTimeRange);
}

struct ExplainCommand {
  ExplainJob job;
  std::string series, ensembles, out;
  int runs = 0, jobs = 0;
  bool quiet = false;
};

void print_earlier_model(const fs::path& out) {
  text::say("\n%s is from an earlier search\n", (out / "model.toml"));
}

void explain_field_data(const ExplainCommand& command, ExplainSetup& setup, const fs::path& out) {
  const Stopwatch watch;
  if (!command.quiet)
    setup.request.progress = [&](const std::string& step) {
      text::say("%s  %s\n", output::clock_text(watch.seconds()), step);
      text::flush_output();
    };
  if (!command.quiet) {
    text::say("%s\n", data_text(setup));
    text::say("the model: %s\n", config::flags_text(setup.configuration));
    for (const std::string& note : setup.notes) text::say("%s\n", note);
    text::flush_output();
  }
  const selection::Explanation found = search_resumably(out, setup);
  const std::string missing = write_explain_page(out, found, setup);
  if (command.quiet) return;
  print_explanation(found, setup);
  const std::string run = command_for_found(out, found, setup);
  if (!run.empty())
    text::say("\nrun it with: %s\n(it starts from noise, not from the measured vesicle)\n", run);
  else if (fs::exists(out / "model.toml"))
    print_earlier_model(out);
  text::say("\nwritten: %s\n", (out / "explain.html"));
  if (!missing.empty()) text::say("missing from the page: %s\n", missing);
}

struct SeriesSetup {
  observations::MeasuredVesicles data;
  config::GivenValues given;  // the model, as its file and the flags say
  config::Configuration model;
  SeriesEnsemblesRequest request;  // as that of the ensembles that are taken over, if any are
};

SeriesSetup read_series_job(const ExplainCommand& command) {
  observations::MeasuredVesicles data = input::read_dataset(command.series);
  input::refuse_without_model(data.composition, command.job.model, command.job.flags);
  const config::GivenValues given = model_said(command.job);
  SeriesSetup setup{std::move(data), given, {given, {}}, {}};
  if (const std::string other = input::other_membrane(setup.data.composition, setup.model);
      !other.empty())
    throw InputError(setup.model.where(&config::RunOptions::case_name) +
                     ": the membrane of the model is " + other);
  refuse_series(setup.data, setup.model);
  const bool discs = run::is_of_discs(setup.model);
  setup.request = {observations::looks(setup.data),
                   command.runs > 0 ? command.runs
                   : discs          ? kRunsOfDiscs
                                    : kRuns,
                   command.jobs,
                   command.job.processors(),
                   command.job.without,
                   kZeroCelsius + setup.data.celsius.value_or(kRoomCelsius),
                   command.quiet};
  if (!command.ensembles.empty())
    take_over_ensembles(command.ensembles, setup.model, setup.request);
  return setup;
}

// False if it was stopped.
bool explain_series_data(const ExplainCommand& command, const SeriesSetup& setup,
                         const fs::path& out, const std::string& go_on) {
  const auto& [data, given, model, request] = setup;
  if (!command.quiet) {
    text::say("%s\nthe model: %s\n", data::title_of(data), config::flags_text(model));
    text::flush_output();
  }
  const fs::path simulations =
      command.ensembles.empty() ? out / "ensembles" : fs::path(command.ensembles);
  SeriesEnsembles ensembles =
      drivers::numerically([&] { return run_series_ensembles(simulations, model, request); });
  if (const std::string note = note_on_looks(request.looks, observations::looks(data));
      !note.empty())
    ensembles.notes.push_back(note);
  if (ensembles.stopped) return false;
  posix::end_on_stop_signals(drivers::kInterrupted, go_on);
  selection::SeriesRequest search{unit_range(model, command.job.diffusion_error)};
  search.replicates = command.job.replicates;
  const selection::SeriesExplanation found = drivers::numerically([&] {
    return selection::explain_series(data, ensembles.base, ensembles.candidates, search);
  });
  // Fields say more: the verdict is theirs if there are any.
  if (command.job.data.empty())
    write_series_verdict(out, command.job.model, given, ensembles, found, search);
  write_series_explanation(out, data, model, ensembles, found, search, command.quiet);
  if (!command.quiet && command.job.data.empty() && !selection::is_named(found.finding) &&
      fs::exists(out / "model.toml"))
    print_earlier_model(out);
  return true;
}

// Series are held against models without any.
bool has_effects(const ExplainJob& job) {
  return !config::Configuration(model_said(job), {}).options().effect.empty();
}

// A folder for --data may hold fields, series or both.
void find_series(ExplainCommand& command) {
  const std::string folder = command.job.data;
  if (folder.empty() || !input::holds_series(folder)) return;
  if (input::holds_fields(folder) && has_effects(command.job)) {
    if (!command.quiet)
      text::say("the series in %s are ignored, because the model has effects\n", folder);
    return;
  }
  if (!command.series.empty())
    throw InputError("--series: " + folder + " of --data also holds series; give one of them");
  command.series = folder;
  if (!input::holds_fields(folder)) command.job.data.clear();
}

void refuse_to_overwrite(const ExplainCommand& command, const fs::path& out) {
  const auto holds = [](const fs::path& file, const fs::path& given) {
    return fs::exists(file) && !given.empty() && fs::exists(given) && fs::equivalent(file, given);
  };
  for (const std::string& data : {command.job.data, command.series})
    if (holds(out, data))
      throw InputError("--out: " + out.string() + " holds the measurements; choose another folder");
  if (holds(out / "model.toml", command.job.model))
    throw InputError(
        "--out: " + out.string() +
        " holds the model, which the extended model would overwrite; choose another folder");
}

// A word is a value of the model, and no file.
void take_word_of_model(ExplainJob& job) {
  if (!config::is_model_word(job.model)) return;
  job.flags["model"] = {job.model, "--model"};
  job.model.clear();
}

// Flow is two of the candidates. Effects that are none may be left out, too.
void refuse_unknown_candidates(const std::vector<std::string>& names) {
  std::vector<std::string> valid = effects::effects().names();
  for (const assimilation::Candidate& candidate : assimilation::candidates())
    if (std::find(valid.begin(), valid.end(), candidate.name) == valid.end())
      valid.push_back(candidate.name);
  std::sort(valid.begin(), valid.end());
  for (const std::string& name : names)
    if (std::find(valid.begin(), valid.end(), name) == valid.end())
      throw InputError("--without: " + unknown_name_message("effect", name, valid));
}

int explain(ExplainCommand command) {
  take_word_of_model(command.job);
  if (command.job.data.empty() && command.series.empty())
    throw InputError("--data or --series: a folder of measurements is needed");
  find_series(command);
  if (command.series.empty() && !command.ensembles.empty())
    throw InputError("--ensembles: there are no series to compare with them");
  refuse_unknown_candidates(command.job.without);
  std::optional<ExplainSetup> fields;
  std::optional<SeriesSetup> series;
  if (!command.series.empty()) series = read_series_job(command);
  if (!command.job.data.empty()) fields = read_explain_job(command.job);
  const fs::path out = command.out.empty() ? run::first_free_folder("explain") : command.out;
  refuse_to_overwrite(command, out);
  run::refuse_foreign_folder(out, {"search.json", "ensembles", "series.json"});
  fs::create_directories(out);
  const posix::FolderLock lock(out);
  // The search is on disk after every refit.
  const std::string go_on = command.quiet ? ""
                                          : "to continue, give the same command with --out " +
                                                text::in_shell(out.string());
  posix::end_on_stop_signals(drivers::kInterrupted, go_on);
  if (fields) explain_field_data(command, *fields, out);
  if (series && !explain_series_data(command, *series, out, go_on)) {
    if (!command.quiet) text::say("%s\n", go_on);
    return drivers::kInterrupted;
  }
  return drivers::kSuccess;
}

drivers::Action define_explain(CLI::App& app) {
  const auto command = std::make_shared<ExplainCommand>();
  app.add_option("--data", command->job.data,
                 "folder of measurements: dataset.toml with fields (snapshot_001.csv, ...), series "
                 "(measurements.csv) or both; this or --series is needed")
      ->type_name("DIR");
  app.add_option("--series", command->series,
                 "folder of series (dataset.toml, measurements.csv), if they are not in --data")
      ->type_name("DIR");
  app.add_option("--runs", command->runs,
                 "for series: number of seeds for the model and for each effect; default: 8, with "
                 "discs 64")
      ->check(CLI::Range(3, 1000));
  app.add_option("--ensembles", command->ensembles,
                 "for series: folder 'ensembles' of an earlier search with the same model; its "
                 "simulations are reused, and missing ones are added to it")
      ->type_name("DIR")
      ->excludes("--runs");
  app.add_option("--jobs", command->jobs,
                 "for series: runs at a time; default: one for each processor")
      ->check(CLI::Range(1, 1024));
  app.add_option("--model", command->job.model,
                 "TOML file of the model, with names of flags as keys; or discs, for series: rafts "
                 "as discs, which are fast and can flow")
      ->type_name("FILE|discs");
  app.add_option("--out", command->out,
                 "folder for the verdict, new or of a search to continue; default: runs/explain-N")
      ->type_name("DIR");
  app.add_option("--most-effects", command->job.effects,
                 "largest number of effects to search for, one after the other")
      ->check(CLI::Range(1, kMostNamedEffects))
      ->capture_default_str();
  app.add_option("--replicates", command->job.replicates,
                 "number of data sets with noise alone that give the p values")
      ->check(CLI::Range(kFewestReplicates, kMostReplicates))
      ->capture_default_str();
  app.add_option("--diffusion-error", command->job.diffusion_error,
                 "relative standard error of a measured D; default: D is fitted freely")
      ->check(config::between(0.001, 1));
  app.add_option("--threads", command->job.threads, "threads; default: one for each processor")
      ->check(CLI::Range(1, 256));
  app.add_option("--without", command->job.without, "effects to leave out of the search")
      ->type_name("EFFECT,...")
      ->delimiter(',');
  app.add_flag("--quiet", command->quiet, "print errors only");
  const auto wanted = [](const config::OptionSpec& spec) {
    return (spec.group == "Physics" || spec.group == "Surface" || spec.group == "Case" ||
            spec.name == "raft-fraction" || spec.name == "initial") &&
           spec.name != "scaled" && spec.name != "model";
  };
  config::add_options(app, command->job.flags, wanted, config::uniform_mesh());
  app.footer(
      "Needs --data, --series or both, and a model.\nExample: traceraft explain --data my-vesicle "
      "--model model.toml --cells 40");
  return [command] { return explain(*command); };
}

}  // namespace

drivers::Command explain_command() {
  return {"explain", "find what a model lacks, from measured fields or series",
          drivers::Ranks::starts_them, define_explain};
}

}  // namespace traceraft::explain
