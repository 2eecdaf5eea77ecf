// traceraft: the command line, and what becomes of exceptions.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "backends/posix/folder_lock.hpp"
#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "backends/suitesparse/blas.hpp"
#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/version.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft {
namespace {

const std::vector<std::string> kCommands = {"run",    "resume",   "compare",
                                            "verify", "fraction", "list"};

// Adds every option that `wanted` accepts as a flag whose text goes to `values`.
template <class Wanted>
void add_options(CLI::App* command, GivenValues& values, const Wanted& wanted) {
  for (const OptionSpec& spec : run_options()) {
    if (!wanted(spec)) continue;
    const std::string flag = "--" + spec.name;
    const auto store = [&values, name = spec.name, flag](const std::string& text) {
      values[name] = {text, flag};
    };
    CLI::Option* option =
        spec.kind == OptionKind::flag
            ? command->add_flag_function(
                  "--" + spec.name + ",!--no-" + spec.name,
                  [store](std::int64_t count) { store(count > 0 ? "true" : "false"); }, spec.help)
            : command->add_option_function<std::string>(flag, store, spec.help);
    option->group(spec.group);
    if (!spec.default_text.empty() && spec.kind != OptionKind::flag)
      option->default_str(spec.default_text)->run_callback_for_default(false);
  }
}

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  return flags;
}

// CLI11 collects what it does not know; the answer names the nearest flag.
void refuse_unknown(const CLI::App& command) {
  for (const std::string& word : command.remaining()) {
    if (word.compare(0, 1, "-") != 0) throw InputError("unexpected '" + word + "'");
    throw InputError(
        unknown_name_message("flag", word.substr(0, word.find('=')), flags_of(command)));
  }
}

int dispatch(int argc, char** argv) {
  CLI::App app{"Predicts how lipid rafts form and coarsen on liposomes.", "traceraft"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  app.footer("Start with: traceraft run --case two-rafts");

  RunRequest run;
  CLI::App* run_app = app.add_subcommand("run", "run a simulation");
  run_app->allow_extras();
  run_app->add_option("--config", run.config_file, "TOML file with the flags' names as keys");
  run_app->add_option("--out", run.out, "run folder; default: runs/<case>-<number>");
  run_app->add_flag("--validate", run.validate, "check everything, then stop");
  run_app->add_flag("--quiet", run.quiet, "print nothing but errors");
  add_options(run_app, run.flags, [](const OptionSpec&) { return true; });
  run_app->footer(
      "Values come from defaults, then the case, then --config, then flags. Exit codes: 0 "
      "success,\n"
      "2 bad input, 3 numerical failure, 4 input/output, 5 interrupted (checkpoint written),\n"
      "6 folder in use.\n"
      "Example: traceraft run --case guv-2to1 --cells 64 --epsilon 0.1 --t-end 100");

  ResumeRequest resume;
  CLI::App* resume_app = app.add_subcommand("resume", "go on with an interrupted run");
  resume_app->allow_extras();
  resume_app->add_option("folder", resume.folder, "run folder")->required();
  resume_app->add_flag("--quiet", resume.quiet, "print nothing but errors");
  add_options(resume_app, resume.flags, [](const OptionSpec& spec) { return !spec.numerical; });

  CompareRequest compare;
  CLI::App* compare_app =
      app.add_subcommand("compare", "compare integrators and linear solvers at equal error");
  compare_app->allow_extras();
  compare_app->add_option("--config", compare.config_file,
                          "TOML file with the flags' names as keys");
  compare_app->add_option("--out", compare.out,
                          "folder, new or of a comparison to go on with or to extend; default: "
                          "runs/compare-<case>-<number>");
  compare_app->add_option("--references", compare.references, "where reference solutions are kept")
      ->capture_default_str();
  compare_app->add_option("--integrators", compare.integrators, "comma-separated; default: all");
  compare_app->add_option("--linear-solvers", compare.linear_solvers,
                          "comma-separated; default: block");
  compare_app->add_option("--tolerances", compare.tolerances,
                          "comma-separated; default: 1e-2,3e-3,1e-3");
  compare_app->add_option("--ranks", compare.ranks,
                          "comma-separated numbers of ranks for the solvers that work on several; "
                          "default: 1");
  compare_app
      ->add_option("--repeat", compare.repeat, "runs of each combination, for its time; default: 3")
      ->check(CLI::Range(1, 1000));
  compare_app->add_option("--time-limit", compare.time_limit, "seconds per run; 0: none")
      ->check(CLI::NonNegativeNumber);
  compare_app
      ->add_option("--target-error", compare.target_error,
                   "error to recommend a method for; default: the smallest that all reach")
      ->check(CLI::PositiveNumber);
  compare_app
      ->add_option("--reference-tolerance", compare.reference_tolerance,
                   "default: a hundredth of the smallest tolerance")
      ->check(CLI::Range(1e-12, 0.1));
  compare_app->add_flag("--quiet", compare.quiet, "print nothing but errors");
  add_options(compare_app, compare.flags, [](const OptionSpec& spec) {
    return spec.group != "Output" && spec.name != "output-times";
  });
  compare_app->footer(
      "Example: traceraft compare --case spinodal --integrators euler,ida --tolerances "
      "1e-2,3e-3,1e-3");

  VerifyRequest verify;
  CLI::App* verify_app = app.add_subcommand("verify", "measure what the program claims");
  verify_app->allow_extras();
  verify_app->add_option("studies", verify.studies, "studies (list shows them), or all")
      ->default_str("all");
  verify_app->add_flag("--quick", verify.quick, "coarser meshes: all studies within 3 minutes");
  verify_app->add_option("--integrator", verify.integrator,
                         "to measure with; default: ida, or all where a study compares");
  verify_app->add_option("--linear-solver", verify.linear_solver,
                         "to measure with; default: block, or all where a study compares");
  verify_app->add_option("--threads", verify.threads, "default: one for each processor")
      ->check(CLI::Range(1, 256));
  verify_app->add_option("--out", verify.out,
                         "folder for tables and page; default: runs/verify-<number>");
  verify_app->add_option("--document", verify.document,
                         "Markdown file for the results; its figures go beside it");
  verify_app->add_flag("--quiet", verify.quiet, "print nothing but errors");
  verify_app->footer(
      "Exit codes: 0 every claim holds, 1 one fails, 2 bad input, 4 input/output.\n"
      "Example: traceraft verify mass energy --quick");

  FractionRequest fraction;
  CLI::App* fraction_app =
      app.add_subcommand("fraction", "estimate the raft fraction of a lipid composition");
  fraction_app->allow_extras();
  fraction_app->add_option("--composition", fraction.composition,
                           "parts of DOPC : DPPC : mol % of cholesterol, such as 3:1:20");
  fraction_app->add_option("--temperature", fraction.celsius, "in degrees Celsius")
      ->check(CLI::Range(-10.0, 60.0))
      ->capture_default_str();
  fraction_app->add_option("--ordered", fraction.ordered,
                           "mol % of DOPC:DPPC:cholesterol in rafts, such as 22:43:35");
  fraction_app->add_option("--disordered", fraction.disordered, "the same around them");
  fraction_app->footer("Example: traceraft fraction --composition 2:1:20 --temperature 19.2");

  CLI::App* list_app = app.add_subcommand("list", "list cases, surfaces, laws and methods");
  list_app->allow_extras();

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);  // --help, --version
  } catch (const CLI::RequiredError&) {
    if (app.get_subcommands().empty() && argc > 1)
      throw InputError(unknown_name_message("command", argv[1], kCommands));
    throw InputError(app.get_subcommands().empty()
                         ? "say what to do: run, resume, compare, verify, fraction or list (see "
                           "traceraft --help)"
                         : "resume: needs the run folder, as in: traceraft resume runs/guv-2to1-1");
  } catch (const CLI::ExtrasError&) {
    throw InputError(unknown_name_message("command", argv[1], kCommands));
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  } catch (const std::logic_error&) {  // CLI11 on --no-fields=perhaps: std::stoll's exceptions
    throw InputError("a flag takes no value but true or false");
  }
  for (const CLI::App* command : app.get_subcommands()) refuse_unknown(*command);
  if (world()->size() > 1 && !run_app->parsed() && !resume_app->parsed())
    throw InputError("only run and resume work on several ranks; start the others without mpirun");
  if (compare_app->parsed() && RankSession::there_is())
    throw InputError("compare starts ranks itself (--ranks); start it without mpirun");
  if (run_app->parsed()) return run_command(run);
  if (resume_app->parsed()) return resume_command(resume);
  if (compare_app->parsed()) return compare_command(compare);
  if (verify_app->parsed()) {
    if (verify.studies.empty()) verify.studies = {"all"};
    return verify_command(verify);
  }
  if (fraction_app->parsed()) return fraction_command(fraction);
  return list_command();
}

// Says what is wrong; if all ranks fail, which is the rule for bad input, the first one says it.
int complain(const std::string& what, int code) {
  const bool alike = RankSession::all_fail();
  const std::shared_ptr<const Communicator> ranks = world();
  std::fflush(stdout);
  if (ranks->root() || !alike) {
    const std::string who = alike ? "" : "rank " + std::to_string(ranks->rank()) + ": ";
    std::fprintf(stderr, "traceraft: %s%s\n", who.c_str(), what.c_str());
  }
  if (!alike) RankSession::abort(code);
  return code;
}

int guarded(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const IoError& error) {
    return complain(error.what(), kInputOutput);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error.what(), kInputOutput);
  } catch (const LockedError& error) {
    return complain(error.what(), kLocked);
  } catch (const std::bad_alloc&) {
    return complain("out of memory; use fewer --cells", kInternalError);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), kInternalError);
  }
}

int run_with_ranks(int argc, char** argv) {
  try {
    const RankSession session;
    return guarded(argc, argv);
  } catch (const InputError& error) {  // there are ranks, but no MPI
    std::fprintf(stderr, "traceraft: %s\n", error.what());
    return kBadInput;
  }
}

}  // namespace
}  // namespace traceraft

int main(int argc, char** argv) {
  // Read by OpenBLAS and by CHOLMOD's OpenMP when they are loaded, hence before anything else.
  traceraft::restart_with_environment(traceraft::preferred_environment(), argv);
  return traceraft::run_with_ranks(argc, argv);
}
