#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/jobs/pending_jobs.hpp"
#include "drivers/jobs/program_run.hpp"
#include "drivers/output/program.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "drivers/verify/verify_jobs.hpp"
#include "drivers/verify/verify_report.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"
#include "verification/bench/bench.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft::verify {
namespace {

namespace fs = std::filesystem;

struct VerifyRequest {
  std::vector<std::string> studies;  // names, "all", or "list" alone
  bool quick = false, quiet = false;
  std::string integrator, linear_solver;  // "": each study's choice, or all where it compares
  int threads = 0;                        // 0: what the jobs leave
  int jobs = 0;                           // studies at a time; 0: all processors if quick, else 1
  std::string out;                        // "" for the first free runs/verify-N
  std::string document;                   // Markdown file to write; "" for none
};

bool holds(const std::vector<studies::StudyEntry>& studies, const studies::StudyEntry& study) {
  return std::any_of(studies.begin(), studies.end(),
                     [&](const studies::StudyEntry& entry) { return entry.name == study.name; });
}

std::vector<studies::StudyEntry> chosen_studies(const VerifyRequest& request) {
  std::vector<studies::StudyEntry> chosen;
  const auto choose = [&](const studies::StudyEntry& study) {
    if (!holds(chosen, study)) chosen.push_back(study);
  };
  for (const std::string& name : request.studies) {
    if (name == "list") throw InputError("verify: list cannot be combined with studies");
    if (name != "all") choose(studies::studies().find(name, {"all", "list"}));
    for (const studies::StudyEntry& study : studies::studies())
      if (name == "all" && !study.by_name_only) choose(study);
  }
  return chosen;
}

// A failure is a result of the study; only what no study is to blame for goes further.
StudyResult carry_out(const studies::StudyEntry& study, const bench::BenchRequest& request,
                      output::StatusLine& line) {
  StudyResult result{study, {}, "", 0};
  const Stopwatch watch;
  bench::BenchRequest with_progress = request;
  with_progress.progress = [&](double share) {
    if (line.due())
      line.show(share, study.name + "  " + output::clock_text(watch.seconds()) + " elapsed");
  };
  try {
    result.report = study.run(bench::Bench(with_progress));
  } catch (const IoError&) {
    throw;
  } catch (const std::runtime_error& error) {
    result.failure = error.what();
  }
  result.seconds = watch.seconds();
  line.finish();
  return result;
}

std::string or_default(const std::string& name) {
  return name.empty() ? "of the study" : name;
}

// The flags that a study is measured with.
std::vector<std::string> flags_of(const VerifyRequest& request, int threads) {
  std::vector<std::string> flags;
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) flags.insert(flags.end(), {flag, value});
  };
  if (request.quick) flags.emplace_back("--quick");
  add("--integrator", request.integrator);
  add("--linear-solver", request.linear_solver);
  add("--threads", threads > 0 ? std::to_string(threads) : "");
  return flags;
}

VerificationContext context_of(const VerifyRequest& request, const bench::BenchRequest& bench) {
  std::string command = "traceraft verify";
  for (const std::string& name : request.studies) command += " " + name;
  for (const std::string& flag : flags_of(request, request.threads)) command += " " + flag;
  if (request.jobs > 0) command += " --jobs " + std::to_string(request.jobs);
  if (!request.document.empty()) command += " --document " + text::in_shell(request.document);
  // The program itself decides the numbers, and what was asked of it.
  const std::string threads = std::to_string(bench.threads) + " threads";
  return {command, output::program_text() + ", " + threads + ".",
          "program " + output::program_checksum() + (request.quick ? ", quick" : "") +
              ", integrator " + or_default(request.integrator) + ", linear solver " +
              or_default(request.linear_solver) + ", " + threads};
}

int list_studies() {
  for (const studies::StudyEntry& study : studies::studies())
    text::say("  %-14s %s%s\n", study.name, study.summary,
              study.by_name_only ? " (not part of all)" : "");
  return drivers::kSuccess;
}

// Those that one can carry out side by side.
std::vector<studies::StudyEntry> sharing(const std::vector<studies::StudyEntry>& studies) {
  std::vector<studies::StudyEntry> found;
  for (const studies::StudyEntry& study : studies)
    if (!study.by_name_only && !study.starts_ranks) found.push_back(study);
  return found;
}

std::vector<studies::StudyEntry> not_measured(const std::vector<studies::StudyEntry>& chosen,
                                              const fs::path& folder,
                                              const std::string& measured_with) {
  std::vector<studies::StudyEntry> left;
  for (const studies::StudyEntry& study : chosen)
    if (!measured_before(folder, study, measured_with)) left.push_back(study);
  return left;
}

void print_verdicts(const std::vector<StudyResult>& results) {
  for (const StudyResult& result : results)
    text::say("  %-14s %s\n", result.study.name, outcome_text(result.outcome()));
}

void refuse_foreign_files(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) throw InputError("--out: " + folder.string() + " is not a folder");
  std::vector<std::string> own = files_of_a_verification();
  for (const std::string& name : files_of_a_verification()) own.push_back("job-*/" + name);
  own.emplace_back("job-*.log");
  if (const fs::path foreign = posix::first_foreign(folder, own); !foreign.empty())
    throw InputError("--out: " + folder.string() + " holds " + foreign.string() +
                     ", which verify did not write; choose another folder");
}

int verify(const VerifyRequest& request) {
  if (request.studies == std::vector<std::string>{"list"}) return list_studies();
  if (!request.document.empty() && !fs::path(request.document).has_extension())
    throw InputError("--document: " + request.document +
                     " needs an extension, as in report.md; the figures go into the folder of this "
                     "name without extension");
  const std::vector<studies::StudyEntry> chosen = chosen_studies(request);
  const bool alone = chosen.size() == 1 || (request.jobs == 0 && !request.quick);
  const jobs::Jobs jobs = jobs::jobs_of(alone ? 1 : request.jobs, request.threads);
  bench::BenchRequest bench{request.quick, request.integrator, request.linear_solver, jobs.threads};
  (void)bench::Bench(bench);  // refuses unknown names before anything is written
  const fs::path folder = request.out.empty() ? run::first_free_folder("verify") : request.out;
  refuse_foreign_files(folder);
  fs::create_directories(folder);
  const posix::FolderLock lock(folder);
  bench.run_program = jobs::program_runner(folder / "ranks");
  const VerificationContext context = context_of(request, bench);

  const std::vector<studies::StudyEntry> left = not_measured(chosen, folder, context.measured_with);
  const StudyJobs side_by_side{sharing(left), flags_of(request, jobs.threads),
                               context.measured_with, jobs.at_a_time, request.quiet};
  const std::string go_on = request.quiet ? ""
                                          : "to continue, give the same command with --out " +
                                                text::in_shell(folder.string());
  if (jobs.at_a_time > 1 && !carry_out_side_by_side(side_by_side, folder)) {
    if (!request.quiet) text::say("%s\n", go_on);
    return drivers::kInterrupted;
  }
  posix::end_on_stop_signals(drivers::kInterrupted,
                             go_on);  // studies are on disk as soon as they are done
  output::StatusLine line(request.quiet);
  std::vector<StudyResult> results;
  bool all = true;
  for (const studies::StudyEntry& study : chosen) {
    if (!request.quiet) text::say("%s: %s\n\n", study.name, study.summary);
    auto before = measured_before(folder, study, context.measured_with);
    if (before && !holds(left, study) && !request.quiet)
      text::say("  (measured earlier, in %s)\n\n", folder);
    results.push_back(before ? std::move(*before) : carry_out(study, bench, line));
    if (!request.quiet) print_result(results.back());
    all = all && results.back().outcome() != StudyOutcome::fails;
    if (!before) write_study(folder, results.back(), context.measured_with);
  }
  const std::string missing = write_verification(folder, context, results);
  if (!request.document.empty()) write_document(request.document, folder, context, results);
  if (!request.quiet) {
    print_verdicts(results);
    if (!missing.empty()) text::say("\nmissing charts: %s\n", missing);
    text::say("\nopen next: %s\n", (folder / "verify.html"));
  }
  return all ? drivers::kSuccess : drivers::kClaimFailed;
}

drivers::Action define_verify(CLI::App& app) {
  const auto request = std::make_shared<VerifyRequest>();
  app.add_option("studies", request->studies, "names of studies, or all; list prints the names")
      ->type_name("STUDY")
      ->default_str("all");
  app.add_flag("--quick", request->quick, "use coarser meshes: all studies take 3 minutes");
  app.add_option(
         "--integrator", request->integrator,
         "integrator to measure with; default: ida, or all where a study compares integrators")
      ->type_name("INTEGRATOR");
  app.add_option(
         "--linear-solver", request->linear_solver,
         "linear solver to measure with; default: block, or all where a study compares solvers")
      ->type_name("SOLVER");
  app.add_option("--threads", request->threads, "threads of a study; default: processors / --jobs")
      ->check(CLI::Range(1, 256));
  app.add_option("--jobs", request->jobs,
                 "number of studies at a time; default: 1, or one for each processor with --quick")
      ->check(CLI::Range(1, 256));
  app.add_option("--out", request->out,
                 "folder for tables and page, new or to continue; default: runs/verify-<number>")
      ->type_name("DIR");
  app.add_option("--document", request->document,
                 "Markdown file for the results; its figures go into a folder of the same name")
      ->type_name("FILE");
  app.add_flag("--quiet", request->quiet, "print errors only");
  app.footer(
      "Exit codes: 0 every claim holds, 1 a claim fails, 2 bad input, 4 input/output,\n5 stopped; "
      "the same command with the same --out continues.\n"
      "Example: traceraft verify mass energy --quick");
  return [request] {
    if (request->studies.empty()) request->studies = {"all"};
    return verify(*request);
  };
}

}  // namespace

drivers::Command verify_command() {
  return {"verify", "measure the claims about the program: conservation, convergence, theory",
          drivers::Ranks::one, define_verify};
}

}  // namespace traceraft::verify
