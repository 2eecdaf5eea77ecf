// traceraft: the command line, and what becomes of exceptions.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <sstream>

#include "backends/posix/address_space.hpp"
#include "backends/posix/process.hpp"
#include "backends/ranks.hpp"
#include "backends/suitesparse/blas.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/config/text_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/output/program.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft {
namespace {

std::vector<std::string> flags_of(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
  return flags;
}

// CLI11 collects what it does not know; the answer names the nearest flag.
void refuse_unknown(const CLI::App& command) {
  for (const std::string& word : command.remaining()) {
    if (word == "--") continue;  // which ends the flags, and is one of those words all the same
    if (word.compare(0, 1, "-") != 0) throw InputError("unexpected '" + word + "'");
    throw InputError(
        unknown_name_message("flag", word.substr(0, word.find('=')), flags_of(command)));
  }
}

// "a, b or c"
std::string any_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  return text;
}

void refuse_ranks(const drivers::Command& command) {
  if (backends::world()->size() > 1 && command.ranks != drivers::Ranks::several)
    throw InputError("only run and resume can use several ranks; start " + command.name +
                     " without mpirun");
  if (command.ranks == drivers::Ranks::starts_them && backends::RankSession::there_is())
    throw InputError(command.name + " starts processes itself; start it without mpirun");
}

// None has a meaning here, and what is made of them in scripts, pages and file names has many.
void refuse_control_characters(int argc, char** argv) {
  for (int k = 1; k < argc; ++k)
    if (std::any_of(argv[k], argv[k] + std::strlen(argv[k]),
                    [](char ch) { return static_cast<unsigned char>(ch) < 32 || ch == 127; }))
      throw InputError("argument " + std::to_string(k) +
                       " contains a control character, such as a line break: " + argv[k]);
}

// "--out=" as the two words --out "": the parser would take the next argument for the value.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const auto end = std::find(words.begin(), words.end(), "--");
  std::vector<std::string> all;
  for (auto word = words.begin(); word != words.end(); ++word) {
    const bool empty =
        word < end && word->compare(0, 2, "--") == 0 && word->find('=') == word->size() - 1;
    all.push_back(empty ? word->substr(0, word->size() - 1) : *word);
    if (empty) all.emplace_back();
  }
  return all;
}

int dispatch(int argc, char** argv) {
  refuse_control_characters(argc, argv);
  CLI::App app{
      "Simulates how lipid rafts form and coarsen on liposomes, and compares with measurements.",
      "traceraft"};
  app.set_version_flag("--version", [] { return output::program_text(); });
  app.require_subcommand(1);
  app.footer("Start with: traceraft run --case two-rafts");

  std::vector<std::pair<CLI::App*, drivers::Action>> defined;
  for (const drivers::Command& command : drivers::commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->allow_extras();
    defined.emplace_back(sub, command.define(*sub));
    config::check_numbers_first(*sub);
    config::refuse_empty_texts(*sub);
  }

  try {
    std::vector<std::string> words = words_of(argc, argv);
    std::reverse(words.begin(), words.end());  // as the parser wants them
    app.parse(std::move(words));
  } catch (const CLI::Success& asked) {
    std::ostringstream text;  // --help, --version
    const int code = app.exit(asked, text);
    text::say_encoded(text.str());
    return code;
  } catch (const CLI::RequiredError& error) {
    if (!app.get_subcommands().empty())
      throw InputError(app.get_subcommands().front()->get_name() + ": " +
                       std::string(error.what()));
    if (argc > 1) (void)drivers::commands().find(argv[1]);
    throw InputError("a command is needed: " + any_of(drivers::commands().names()) +
                     " (see traceraft --help)");
  } catch (const CLI::ExtrasError&) {
    (void)drivers::commands().find(argv[1]);
    throw InputError("give one command at a time");
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  } catch (const std::logic_error&) {  // CLI11 on --no-fields=perhaps: std::stoll's exceptions
    throw InputError("a flag takes no value except true or false");
  }
  const CLI::App& asked_for = *app.get_subcommands().front();
  refuse_unknown(asked_for);
  refuse_ranks(drivers::commands().find(asked_for.get_name()));
  return std::find_if(defined.begin(), defined.end(),
                      [&](const auto& entry) { return entry.first == &asked_for; })
      ->second();
}

// Says what is wrong; if all ranks fail, which is the rule for bad input, the first one says it.
int complain(const std::string& what, int code) {
  const bool alike = backends::RankSession::all_fail();
  const std::shared_ptr<const Communicator> ranks = backends::world();
  text::flush_output();
  if (ranks->root() || !alike) {
    const std::string who = alike ? "" : "rank " + std::to_string(ranks->rank()) + ": ";
    text::say_error(who + what);
  }
  if (!alike) backends::RankSession::abort(code);
  return code;
}

int guarded(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (...) {
    const drivers::Failure failure = drivers::failure_of(std::current_exception());
    return complain(failure.why, failure.code);
  }
}

// Output that could not be written is lost, even if everything else was done.
int with_output_checked(int code) {
  const std::string why = text::output_error();
  if (why.empty()) return code;
  text::say_error("cannot write to the standard output: " + why);
  return code == drivers::kSuccess ? drivers::kInputOutput : code;
}

int run_with_ranks(int argc, char** argv) {
  try {
    const backends::RankSession session;
    return with_output_checked(guarded(argc, argv));
  } catch (const InputError& error) {  // there are ranks, but no MPI
    text::say_error(error.what());
    return drivers::kBadInput;
  }
}

}  // namespace
}  // namespace traceraft

// Called before libraries start.
__attribute__((section(".preinit_array"), used)) static void (*const kBeforeLibraries)(int, char**,
                                                                                       char**) =
    traceraft::posix::require_address_space<traceraft::drivers::kInternalError>;

int main(int argc, char** argv) {
  traceraft::posix::occupy_standard_descriptors();
  traceraft::posix::ignore_file_size_signal();
  // Read by OpenBLAS when it is loaded, hence before anything else.
  traceraft::posix::restart_with_environment(traceraft::suitesparse::preferred_environment(), argv);
  traceraft::suitesparse::use_one_blas_thread();
  return traceraft::run_with_ranks(argc, argv);
}
