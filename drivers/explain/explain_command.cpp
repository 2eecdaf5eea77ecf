#include <CLI/CLI.hpp>
#include <cstdio>

#include "backends/posix/folder_lock.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/explain/explain_page.hpp"
#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/explain_run.hpp"
#include "drivers/explain/search_file.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/run_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct ExplainCommand {
  ExplainJob job;
  std::string out;
  bool quiet = false;
};

int explain(const ExplainCommand& command) {
  ExplainSetup setup = read_explain_job(command.job);
  const Stopwatch watch;
  if (!command.quiet)
    setup.request.progress = [&](const std::string& step) {
      std::printf("%s  %s\n", clock_text(watch.seconds()).c_str(), step.c_str());
      std::fflush(stdout);
    };
  const fs::path out = command.out.empty() ? first_free_folder("explain") : command.out;
  fs::create_directories(out);
  const FolderLock lock(out);
  const SearchFile file(out, setup);
  setup.request.save = [&](const SearchState& state) { file.save(state); };
  const Explanation found = explain_fields(setup.series, setup.request, file.load());
  write_explanation(out, found, setup.model);
  const std::string missing = write_explain_page(out, found, setup);
  if (!command.quiet) {
    print_explanation(found, setup.model);
    std::printf("\nwritten: %s\n", (out / "explain.html").c_str());
    if (!missing.empty()) std::printf("the page lacks: %s\n", missing.c_str());
  }
  return kSuccess;
}

Action define(CLI::App& app) {
  const auto command = std::make_shared<ExplainCommand>();
  app.add_option("--data", command->job.data,
                 "folder of measured fields (dataset.toml, snapshot_001.csv, ...)");
  app.add_option("--model", command->job.model, "TOML file with the flags' names as keys");
  app.add_option("--out", command->out, "folder for the verdict; default: runs/explain-N");
  app.add_option("--effects", command->job.effects, "most effects to look for, one after the other")
      ->check(CLI::Range(1, 5))
      ->capture_default_str();
  app.add_option("--replicates", command->job.replicates,
                 "of noise alone, that what is found is judged by")
      ->check(CLI::Range(49, 9999))
      ->capture_default_str();
  app.add_option("--threads", command->job.threads, "default: one for each processor")
      ->check(CLI::Range(1, 256));
  app.add_option("--without", command->job.without, "effects that are not looked for")
      ->delimiter(',');
  app.add_flag("--quiet", command->quiet, "print nothing but errors");
  add_options(app, command->job.flags, [](const OptionSpec& spec) {
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
