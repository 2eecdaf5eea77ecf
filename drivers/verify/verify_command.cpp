#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "backends/posix/child.hpp"
#include "backends/posix/durable_file.hpp"
#include "backends/posix/folder_lock.hpp"
#include "backends/zlib/checksum.hpp"
#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/run/program_run.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/verify/verify_report.hpp"
#include "drivers/version.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/stopwatch.hpp"
#include "kernel/core/text.hpp"
#include "verification/bench.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct VerifyRequest {
  std::vector<std::string> studies;  // names, "all", or "list" alone
  bool quick = false, quiet = false;
  std::string integrator, linear_solver;  // "": each study's choice, or all where it compares
  int threads = 0;                        // 0: one for each processor
  std::string out;                        // "" for the first free runs/verify-N
  std::string document;                   // Markdown file to write; "" for none
};

constexpr std::uint64_t kLargestProgram = std::uint64_t{1} << 32;

std::vector<StudyEntry> chosen_studies(const VerifyRequest& request) {
  std::vector<StudyEntry> chosen;
  for (const std::string& name : request.studies) {
    if (name != "all") chosen.push_back(studies().find(name, {"all", "list"}));
    for (const StudyEntry& study : studies())
      if (name == "all" && !study.by_name_only) chosen.push_back(study);
  }
  return chosen;
}

// A failure is a result of the study; only what no study is to blame for goes further.
StudyResult carry_out(const StudyEntry& study, const BenchRequest& request, StatusLine& line) {
  StudyResult result{study, {}, "", 0};
  const Stopwatch watch;
  BenchRequest with_progress = request;
  with_progress.progress = [&](double share) {
    if (line.due()) line.show(share, study.name + "  " + clock_text(watch.seconds()) + " elapsed");
  };
  try {
    result.report = study.run(Bench(with_progress));
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

VerificationContext context_of(const VerifyRequest& request, const BenchRequest& bench) {
  std::string command = "traceraft verify";
  for (const std::string& name : request.studies) command += " " + name;
  if (request.quick) command += " --quick";
  if (!request.integrator.empty()) command += " --integrator " + request.integrator;
  if (!request.linear_solver.empty()) command += " --linear-solver " + request.linear_solver;
  if (request.threads > 0) command += " --threads " + std::to_string(request.threads);
  if (!request.document.empty()) command += " --document " + request.document;
  // The program itself decides the numbers, and what was asked of it.
  const std::string program = formatted("%08x", crc32_of(read_file(own_path(), kLargestProgram)));
  const std::string threads = std::to_string(bench.threads) + " threads";
  return {command, "traceraft " + std::string(kVersion) + ", " + threads + ".",
          "program " + program + (request.quick ? ", quick" : "") + ", integrator " +
              or_default(request.integrator) + ", linear solver " +
              or_default(request.linear_solver) + ", " + threads};
}

int list_studies() {
  for (const StudyEntry& study : studies())
    std::printf("  %-14s %s%s\n", study.name.c_str(), study.summary.c_str(),
                study.by_name_only ? " (not part of all)" : "");
  return kSuccess;
}

int verify(const VerifyRequest& request) {
  if (request.studies == std::vector<std::string>{"list"}) return list_studies();
  const std::vector<StudyEntry> chosen = chosen_studies(request);
  BenchRequest bench{request.quick, request.integrator, request.linear_solver, request.threads};
  if (bench.threads == 0)
    bench.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  (void)Bench(bench);  // refuses unknown names before anything is written
  const fs::path folder = request.out.empty() ? first_free_folder("verify") : request.out;
  fs::create_directories(folder);
  const FolderLock lock(folder);
  bench.run_program = program_runner(folder / "ranks");
  const VerificationContext context = context_of(request, bench);

  StatusLine line(request.quiet);
  std::vector<StudyResult> results;
  bool all = true;
  for (const StudyEntry& study : chosen) {
    if (!request.quiet) std::printf("%s: %s\n\n", study.name.c_str(), study.summary.c_str());
    auto before = measured_before(folder, study, context.measured_with);
    if (before && !request.quiet) std::printf("  (measured before, in %s)\n\n", folder.c_str());
    results.push_back(before ? std::move(*before) : carry_out(study, bench, line));
    if (!request.quiet) print_result(results.back());
    all = all && results.back().verdict() != Verdict::fails;
    if (!before) write_study(folder, results.back(), context.measured_with);
  }
  const std::string missing = write_verification(folder, context, results);
  if (!request.document.empty()) write_document(request.document, folder, context, results);
  if (!request.quiet) {
    for (const StudyResult& result : results)
      std::printf("  %-14s %s\n", result.study.name.c_str(), verdict_text(result.verdict()));
    if (!missing.empty()) std::printf("\ncharts are missing: %s\n", missing.c_str());
    std::printf("\nopen next: %s\n", (folder / "verify.html").c_str());
  }
  return all ? kSuccess : kClaimFailed;
}

Action define(CLI::App& app) {
  const auto request = std::make_shared<VerifyRequest>();
  app.add_option("studies", request->studies, "studies (list shows them), or all")
      ->default_str("all");
  app.add_flag("--quick", request->quick, "coarser meshes: all studies within 3 minutes");
  app.add_option("--integrator", request->integrator,
                 "to measure with; default: ida, or all where a study compares");
  app.add_option("--linear-solver", request->linear_solver,
                 "to measure with; default: block, or all where a study compares");
  app.add_option("--threads", request->threads, "default: one for each processor")
      ->check(CLI::Range(1, 256));
  app.add_option("--out", request->out,
                 "folder for tables and page; default: runs/verify-<number>");
  app.add_option("--document", request->document,
                 "Markdown file for the results; its figures go beside it");
  app.add_flag("--quiet", request->quiet, "print nothing but errors");
  app.footer(
      "Exit codes: 0 every claim holds, 1 one fails, 2 bad input, 4 input/output.\n"
      "Example: traceraft verify mass energy --quick");
  return [request] {
    if (request->studies.empty()) request->studies = {"all"};
    return verify(*request);
  };
}

}  // namespace

Command verify_command() {
  return {"verify", "measure what the program claims", Ranks::one, define};
}

}  // namespace traceraft
