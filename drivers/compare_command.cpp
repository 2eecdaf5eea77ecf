#include <algorithm>
#include <cstdio>

#include "backends/list.hpp"
#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/checkpoint_store.hpp"
#include "drivers/commands.hpp"
#include "drivers/compare_report.hpp"
#include "drivers/comparison.hpp"
#include "drivers/config_file.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/run_folder.hpp"
#include "drivers/run_setup.hpp"
#include "drivers/status_line.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

// The reference is this much tighter than the tightest run.
constexpr double kReferenceFactor = 100;
constexpr const char* kReferenceLinearTolerance = "1e-4";

// Empty items do not count.
std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> items = split_list(text);
  items.erase(std::remove(items.begin(), items.end(), ""), items.end());
  return items;
}

template <class List>
std::vector<std::string> names_in(const List& list, const char* flag, const std::string& text) {
  const std::vector<std::string> names = words(text);
  if (names.empty()) throw InputError(std::string(flag) + ": name at least one");
  try {
    for (const std::string& name : names) (void)list.find(name);
  } catch (const InputError& error) {
    throw InputError(std::string(flag) + ": " + error.what());
  }
  return names;
}

// The plan in the folder, if there is one, changed by what the user asks for now.
ComparePlan make_plan(const CompareRequest& request, const ComparisonFolder& folder) {
  ComparePlan plan;
  if (folder.started()) {
    plan = folder.load();
  } else {
    plan.integrators = integrators().names();
    plan.linear_solvers = {"block"};
    plan.tolerances = {1e-2, 3e-3, 1e-3};
  }
  if (!request.integrators.empty())
    plan.integrators = names_in(integrators(), "--integrators", request.integrators);
  if (!request.linear_solvers.empty())
    plan.linear_solvers = names_in(linear_solvers(), "--linear-solvers", request.linear_solvers);
  if (!request.tolerances.empty()) {
    plan.tolerances.clear();
    for (const std::string& word : words(request.tolerances)) {
      const double tolerance = parse_number("--tolerances", word);
      if (!(tolerance >= 1e-12 && tolerance <= 0.5))
        throw InputError("--tolerances: " + word + " is out of range (allowed: 1e-12 to 0.5)");
      plan.tolerances.push_back(tolerance);
    }
    if (plan.tolerances.empty()) throw InputError("--tolerances: give at least one");
  }
  if (request.repeat > 0) plan.repeat = request.repeat;
  if (request.time_limit >= 0) plan.time_limit = request.time_limit;
  if (request.target_error > 0) plan.target_error = request.target_error;
  if (request.reference_tolerance > 0) plan.reference_tolerance = request.reference_tolerance;
  if (plan.reference_tolerance == 0)
    plan.reference_tolerance =
        std::max(1e-12, *std::min_element(plan.tolerances.begin(), plan.tolerances.end()) /
                            kReferenceFactor);
  return plan;
}

// All options of the runs but integrator, linear solver and tolerance.
Configuration make_configuration(const CompareRequest& request, const ComparisonFolder& folder) {
  const bool given = !request.flags.empty() || !request.config_file.empty();
  if (folder.started() && !given) return {read_config_file(folder.config()), {}};
  const GivenValues file = read_config_file(request.config_file);
  GivenValues flags = request.flags;
  for (const char* varied : {"integrator", "linear-solver", "tolerance"})
    if (flags.count(varied))
      throw InputError(std::string("--") + varied + ": a comparison takes --" + varied + "s");
  flags["output-times"] = {Configuration(file, flags).text("t-end"), "--t-end"};
  const Configuration configuration(file, flags);
  if (folder.started() &&
      numerical_identity(Configuration(read_config_file(folder.config()), {})) !=
          numerical_identity(configuration))
    throw InputError("--out: " + folder.path().string() +
                     " holds a comparison of other runs; choose another folder, or give only "
                     "--out to go on with it");
  return configuration;
}

// Runs this program with the arguments and says why it failed, "" if it did not. A stop is told by
// stop_requested().
std::string carry_out(const std::vector<std::string>& arguments, const fs::path& log,
                      double time_limit, const std::function<void()>& tick) {
  std::vector<std::string> command = {own_program().string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ChildResult result = run_child({command, log, time_limit, tick});
  if (result.exit_code == kSuccess) return "";
  if (result.out_of_time) return "stopped after " + format_number(time_limit) + " s";
  std::string text = read_file(log, 1 << 24);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const std::string last = text.substr(text.rfind('\n') + 1);
  return last.empty() ? "exit code " + std::to_string(result.exit_code) : last;
}

struct Reference {
  GivenValues options;
  fs::path folder;
};

// The same reference serves all comparisons of the same runs: its folder is named by its options.
Reference reference_of(const ComparePlan& plan, const ComparisonFolder& folder,
                       const std::string& cache) {
  Reference reference;
  reference.options = {{"integrator", {"ida", ""}},
                       {"linear-solver", {"block", ""}},
                       {"linear-tolerance", {kReferenceLinearTolerance, ""}},
                       {"tolerance", {format_number(plan.reference_tolerance), ""}}};
  const std::string identity =
      numerical_identity(Configuration(read_config_file(folder.config()), reference.options));
  char name[16];
  std::snprintf(name, sizeof name, "%08x", crc32_of(identity));
  reference.folder = fs::path(cache) / name;
  if (fs::exists(reference.folder / "config.toml") &&
      numerical_identity(Configuration(read_config_file(reference.folder / "config.toml"), {})) !=
          identity)
    throw InputError("--references: " + reference.folder.string() +
                     " holds another run of the same name; choose another folder");
  return reference;
}

void compute(const Reference& reference, const ComparisonFolder& folder,
             const std::function<void()>& tick) {
  fs::create_directories(reference.folder.parent_path());
  std::vector<std::string> arguments = {"resume", reference.folder.string(), "--quiet"};
  if (!fs::exists(reference.folder / "config.toml")) {
    arguments = {
        "run",         "--config", folder.config().string(), "--out", reference.folder.string(),
        "--no-fields", "--quiet"};
    for (const auto& [option, value] : reference.options) {
      arguments.push_back("--" + option);
      arguments.push_back(value.text);
    }
  }
  const std::string failure = carry_out(arguments, folder.path() / "reference.log", 0, tick);
  if (!failure.empty() && !stop_requested()) throw IoError("the reference failed: " + failure);
}

void compute(const CompareJob& job, const ComparisonFolder& folder, double time_limit,
             const std::function<void()>& tick) {
  // What an interruption left of a run of ours: its times mean nothing.
  fs::remove_all(folder.run_of(job));
  const std::string failure = carry_out(
      {"run", "--config", folder.config().string(), "--integrator", job.integrator,
       "--linear-solver", job.linear_solver, "--tolerance", format_number(job.tolerance), "--out",
       folder.run_of(job).string(), "--no-fields", "--checkpoint-interval", "1e9", "--quiet"},
      folder.log_of(job), time_limit, tick);
  if (!stop_requested()) folder.record(job, failure);
}

// Carries out what the plan still lacks. False if it was asked to stop.
bool work_off(const ComparePlan& plan, const ComparisonFolder& folder, const Reference& reference,
              bool quiet) {
  const std::vector<CompareJob> jobs = jobs_of(plan);
  StatusLine line(quiet);
  const Stopwatch watch;
  long done = 0, total = static_cast<long>(jobs.size()) + 1, worked = 0;
  const auto tick_for = [&](const std::string& what) {
    return [&, what] {
      if (!line.due()) return;
      const double left = worked > 0 ? watch.seconds() / static_cast<double>(worked) *
                                           static_cast<double>(total - done)
                                     : 0;
      line.show(static_cast<double>(done) / static_cast<double>(total),
                std::to_string(done) + "/" + std::to_string(total) + "  " + what + "  " +
                    clock_text(watch.seconds()) + " elapsed" +
                    (left > 0 ? "  ~" + clock_text(left) + " left" : ""));
    };
  };
  if (!run_finished(reference.folder)) {
    compute(reference, folder,
            tick_for("reference: ida at " + format_number(plan.reference_tolerance)));
    ++worked;
  }
  ++done;
  for (const CompareJob& job : jobs) {
    if (stop_requested()) break;
    if (!folder.done(job)) {
      compute(job, folder, plan.time_limit, tick_for(job.name()));
      ++worked;
    }
    ++done;
  }
  line.finish();
  return !stop_requested();
}

}  // namespace

int compare_command(const CompareRequest& request) {
  catch_stop_signals();
  std::string out = request.out;
  if (out.empty()) {
    const auto chosen = request.flags.find("case");
    out = first_free_folder("compare-" + (chosen == request.flags.end()
                                              ? run_option("case").default_text
                                              : chosen->second.text));
  }
  const ComparisonFolder folder(out);
  const ComparePlan plan = make_plan(request, folder);
  const Configuration configuration = make_configuration(request, folder);
  RunSetup run = build_run(configuration, InitialState::build);
  fs::create_directories(folder.path() / "runs");
  const FolderLock lock(folder.path());
  if (!folder.started()) write_durably(folder.config(), config_text(configuration));
  folder.save(plan);

  const Reference reference = reference_of(plan, folder, request.references);
  if (!request.quiet)
    std::printf(
        "comparing %zu integrators, %zu linear solvers and %zu tolerances, %d times, on %d "
        "unknowns\nfolder %s\n",
        plan.integrators.size(), plan.linear_solvers.size(), plan.tolerances.size(), plan.repeat,
        run.problem->size(), out.c_str());
  if (!work_off(plan, folder, reference, request.quiet)) {
    if (!request.quiet) std::printf("go on with: traceraft compare --out %s\n", out.c_str());
    return kInterrupted;
  }
  const std::vector<WorkPoint> points =
      folder.points(plan, *run.problem, newest_concentration(reference.folder, run.space->nodes()));
  const Recommendation advice = recommend(points, plan.target_error);
  write_report(
      folder, points, advice,
      {"Errors are those of c at t = " + configuration.text("t-end") +
           (run.units.scaled ? "" : " s") +
           ", relative in L2 of the surface, against ida with block at tolerance " +
           format_number(plan.reference_tolerance) + " and linear tolerance " +
           kReferenceLinearTolerance + " on the same mesh: of the time integration alone.",
       "Every run is a process of its own with " + std::to_string(run.team->size()) +
           " threads; times are medians of " + std::to_string(plan.repeat) + ", set-up included."});
  if (!request.quiet) {
    print_points(points);
    std::printf("\n%s\n\nopen next: %s\n", advice.sentence.c_str(),
                (folder.path() / "compare.html").c_str());
  }
  return advice.cheapest.empty() ? kNumericalFailure : kSuccess;
}

}  // namespace traceraft
