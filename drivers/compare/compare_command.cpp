#include <algorithm>
#include <optional>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/commands.hpp"
#include "drivers/compare/compare_report.hpp"
#include "drivers/compare/compare_runs.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/config/option_flags.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/program.hpp"
#include "drivers/run/finished_run.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/run/run_mesh.hpp"
#include "drivers/run/run_setup.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::compare {
namespace {

namespace fs = std::filesystem;

// Refuses options that the comparison itself decides for its runs.
void refuse_varied(const config::GivenValues& values) {
  for (const auto& [name, flags] :
       {std::pair("integrator", "--integrators"), std::pair("linear-solver", "--linear-solvers"),
        std::pair("tolerance", "--tolerances"), std::pair("ida-rtol", "--tolerances")})
    if (const auto given = values.find(name); given != values.end())
      throw InputError(given->second.where + ": for a comparison, give " + flags);
}

bool decides_numbers(const config::GivenValues& values) {
  return std::any_of(values.begin(), values.end(),
                     [](const auto& value) { return config::run_option(value.first).numerical; });
}

// All options of the runs but integrator, linear solver and tolerance.
config::Configuration new_configuration(config::GivenValues file, config::GivenValues flags,
                                        const std::string& out) {
  if (!decides_numbers(file) && !decides_numbers(flags))
    throw InputError((out.empty() ? "compare: " : "--out: " + out + " holds no comparison; ") +
                     std::string("a model is needed, as in --case spinodal"));
  file.merge(config::uniform_mesh());
  flags["output-times"] = {format_number(config::Configuration(file, flags).options().t_end),
                           "--t-end"};
  return {file, flags};
}

// The configuration of a comparison that goes on. Its runs must stay comparable.
config::Configuration known_configuration(const ComparisonFolder& folder,
                                          const config::GivenValues& file,
                                          const config::GivenValues& flags) {
  config::Configuration known(config::read_config_file(folder.config()), {});
  const auto refuse = [&](const std::string& what) {
    throw InputError("--out: " + folder.path().string() + " holds a comparison of " + what +
                     "; choose another folder, or give only --out to continue it");
  };
  if (decides_numbers(file) || decides_numbers(flags))
    if (config::numerical_identity(new_configuration(file, flags, "")) !=
        config::numerical_identity(known))
      refuse("other runs");
  for (const config::GivenValues* given : {&file, &flags})
    if (const auto threads = given->find("threads"); threads != given->end())
      if (config::Configuration({}, *given).options().threads != known.options().threads)
        refuse("runs with --threads " + std::to_string(known.options().threads));
  return known;
}

// The checksum of a state, bit by bit.
std::uint32_t checksum(const Vec& state) {
  return zlib::crc32_of({reinterpret_cast<const char*>(state.data()),
                         static_cast<std::size_t>(state.size()) * sizeof(double)});
}

std::string folder_name(const CompareRequest& request, const config::Configuration& configuration) {
  return request.out.empty()
             ? run::first_free_folder("compare-" + configuration.options().case_name)
             : request.out;
}

std::vector<std::string> explanations(const config::Configuration& configuration,
                                      const run::RunSetup& run, const ComparePlan& plan) {
  return {"The error is that of c at t = " + format_number(configuration.options().t_end) +
              (run.units.scaled ? "" : " s") +
              ", relative in the L2 norm on the surface. The reference is ida with block at "
              "tolerance " +
              format_number(plan.reference()) + " and linear tolerance " +
              kReferenceLinearTolerance +
              " on the same mesh. The error measures the time integration alone.",
          "Every run is a process of its own. Times are medians of " + std::to_string(plan.repeat) +
              " runs and include the set-up."};
}

// Everything after the folder is ours.
int carry_out(const CompareRequest& request, const ComparisonFolder& folder,
              const ComparePlan& plan, const config::Configuration& configuration,
              const run::RunSetup& run) {
  const Reference reference = reference_of(plan, folder, request.references);
  if (!request.quiet)
    text::say(
        "runs: %zu; integrators: %s; linear solvers: %s; tolerances: %zu; repetitions: %d; "
        "unknowns: %d\nfolder %s\n",
        jobs_of(plan).size(), joined(plan.integrators, ", "), joined(plan.linear_solvers, ", "),
        plan.tolerances.size(), plan.repeat, run.problem->size(), folder.path());
  std::string why;
  switch (run_comparison(plan, folder, reference, request.quiet, why)) {
    case WorkEnd::stopped:
      if (!request.quiet)
        text::say("continue with: traceraft compare --out %s\n",
                  text::in_shell(folder.path().string()));
      return drivers::kInterrupted;
    case WorkEnd::reference_failed:
      text::say_error("the reference failed: " + why);
      return drivers::kNumericalFailure;
    case WorkEnd::done:
      break;
  }
  const std::vector<bench::WorkPoint> points = folder.points(
      plan, *run.problem, run::concentration_at_end(reference.folder, run.space->nodes()));
  const bench::Recommendation advice = bench::recommend(points, plan.target_error);
  write_report(folder, points, advice, explanations(configuration, run, plan));
  if (!request.quiet) {
    print_points(points);
    text::say("\n%s\n\nopen next: %s\n", advice.sentence, (folder.path() / "compare.html"));
  }
  return bench::any_result(points) ? drivers::kSuccess : drivers::kNumericalFailure;
}

int compare(const CompareRequest& request) {
  posix::catch_stop_signals();
  config::GivenValues file = config::read_config_file(request.config_file);
  // Those that the program writes have them.
  for (const char* varied : {"integrator", "linear-solver", "tolerance", "ida-rtol"})
    file.erase(varied);
  refuse_varied(request.flags);
  if (!request.out.empty() && fs::exists(request.out) && !fs::is_directory(request.out))
    throw InputError("--out: " + request.out + " is a file");

  // A folder that exists is locked before anything in it is believed.
  std::optional<posix::FolderLock> lock;
  if (!request.out.empty() && !ComparisonFolder(request.out).started())
    run::refuse_before_lock(request.out);
  if (!request.out.empty() && fs::exists(request.out)) lock.emplace(request.out);
  const bool goes_on = !request.out.empty() && ComparisonFolder(request.out).started();
  if (!goes_on && !request.out.empty()) run::refuse_files_of_a_run(request.out);
  const config::Configuration configuration =
      goes_on ? known_configuration(ComparisonFolder(request.out), file, request.flags)
              : new_configuration(file, request.flags, request.out);
  run::refuse_adaptive_mesh(configuration);
  const ComparisonFolder folder(folder_name(request, configuration));
  std::optional<ComparePlan> before;
  if (goes_on) before = folder.load();
  ComparePlan plan = extended_plan(request, before ? &*before : nullptr);
  plan.program = output::program_checksum();
  if (before && before->program != plan.program)
    throw InputError("--out: " + folder.path().string() +
                     " holds runs of another build of traceraft; choose another folder");
  const run::RunSetup run =
      run::build_run(configuration, {},
                     {{"integrator", plan.integrators}, {"linear-solver", plan.linear_solvers}});
  plan.initial_state = checksum(run.initial);
  if (before && before->initial_state != plan.initial_state)
    throw InputError("--out: " + folder.path().string() +
                     " holds a comparison with another initial state; choose another folder");

  posix::make_inner_folder(folder.path() / "runs");
  if (!lock) lock.emplace(folder.path());
  if (!goes_on && folder.started()) run::refuse_begun(folder.path());
  if (!goes_on) posix::write_durably(folder.config(), config::config_text(configuration));
  folder.save(plan);
  return carry_out(request, folder, plan, configuration, run);
}

drivers::Action define_compare(CLI::App& app) {
  const auto request = std::make_shared<CompareRequest>();
  app.add_option("--config", request->config_file,
                 "TOML file of settings, with names of flags as keys")
      ->type_name("FILE");
  app.add_option("--out", request->out,
                 "new folder, or folder of a comparison to continue or extend; default: "
                 "runs/compare-<case>-<number>")
      ->type_name("DIR");
  app.add_option("--references", request->references, "folder that keeps reference solutions")
      ->type_name("DIR")
      ->capture_default_str();
  app.add_option("--integrators", request->integrators,
                 "integrators, comma-separated; default: all")
      ->type_name("INTEGRATOR,...");
  app.add_option("--linear-solvers", request->linear_solvers,
                 "linear solvers, comma-separated; default: block")
      ->type_name("SOLVER,...");
  app.add_option("--tolerances", request->tolerances,
                 "tolerances, comma-separated; default: 1e-2,3e-3,1e-3")
      ->type_name("NUMBER,...");
  app.add_option("--ranks", request->ranks,
                 "numbers of ranks, for the solvers that work on several; default: 1")
      ->type_name("NUMBER,...");
  app.add_option("--repeat", request->repeat,
                 "runs of each combination, whose median is its time; default: 3")
      ->check(CLI::Range(1, kMostRepetitions));
  app.add_option("--time-limit", request->time_limit, "longest time of a run (s); 0: no limit")
      ->check(config::at_least(0));
  app.add_option("--target-error", request->target_error,
                 "error at which a method is recommended; default, 0: the smallest that all reach")
      ->check(config::at_least(0));
  app.add_option("--reference-tolerance", request->reference_tolerance,
                 "tolerance of the reference; default: a hundredth of the smallest tolerance")
      ->check(config::between(1e-12, 0.1));
  app.add_flag("--quiet", request->quiet, "print errors only");
  const auto wanted = [](const config::OptionSpec& spec) {
    return spec.group != "Output" && spec.name != "output-times" && spec.name != "model";
  };
  config::add_options(app, request->flags, wanted, config::uniform_mesh());
  app.footer(
      "Example: traceraft compare --case spinodal --integrators euler,ida --tolerances "
      "1e-2,3e-3,1e-3");
  return [request] { return compare(*request); };
}

}  // namespace

drivers::Command compare_command() {
  return {"compare", "compare integrators and linear solvers at equal error",
          drivers::Ranks::starts_them, define_compare};
}

}  // namespace traceraft::compare
