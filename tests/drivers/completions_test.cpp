// Shells are asked what they make of the completions that the program writes.
#include "drivers/manual/completions.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <set>
#include <sstream>

#include "backends/list.hpp"
#include "drivers/commands.hpp"
#include "drivers/manual/shell_tables.hpp"
#include "drivers/manual/value_lists.hpp"
#include "drivers/text/encoders.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

using testing::ProgramEnd;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;
using Names = std::set<std::string>;

Names lines(const std::string& text) {
  std::istringstream in(text);
  Names result;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) result.insert(line);
  return result;
}

// The registered commands, as a parser that no command line has been given to.
manual::DescribedProgram registered() {
  CLI::App app{"", "traceraft"};
  for (const drivers::Command& command : drivers::commands())
    (void)command.define(*app.add_subcommand(command.name, command.summary));
  return manual::describe(app);
}

// A shell with the completions in a file.
class CompletionsTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;

  void write(const std::string& language) {
    const ProgramEnd end = traceraft("completions " + language);
    ASSERT_EQ(end.code, 0) << end.output;
    posix::write_durably(folder.path / language, end.output);
  }
  // The output of a shell that reads that file before a script.
  std::string said(const std::string& language, const std::string& script) {
    posix::write_durably(folder.path / "script", script);
    return shell("cd " + folder.path.string() + " && " + language + " script").output;
  }
  // Bash has split the words, also at "=".
  Names bash(const std::string& words) {
    return lines(said("bash",
                      "source ./bash\n"
                      "compopt() { printf '<%s>\\n' \"$2\"; }\n"
                      "COMP_WORDS=(traceraft " +
                          words +
                          ") COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                          "_traceraft\n"
                          "printf '%s\\n' \"${COMPREPLY[@]}\"\n"));
  }
  // The offered names are read from the arrays that _describe is given.
  Names zsh(const std::string& words) {
    return lines(said("zsh -f", "words=(traceraft " + words +
                                    ") CURRENT=$#words\n"
                                    "_describe() { print -l -- ${${(P)4}%%:*}; }\n"
                                    "_files() { print -- \"<files $*>\"; }\n"
                                    "compset() { :; }\n"
                                    "source ./zsh\n"));
  }
  // Names come with a tab and what they mean.
  Names fish(const std::string& line) {
    return lines(said("fish --no-config", "source ./fish\ncomplete -C " +
                                              text::in_fish("traceraft " + line) +
                                              " | string split -f 1 \\t\n"));
  }
};

Names names_of(const std::vector<std::string>& list) {
  return {list.begin(), list.end()};
}

TEST_F(CompletionsTest, BashCompletesCommandsAndOptions) {
  write("bash");
  EXPECT_EQ(bash("ru"), Names{"run"});
  EXPECT_EQ(bash("--v"), Names{"--version"});
  EXPECT_EQ(bash("run --integ"), Names{"--integrator"});
  EXPECT_EQ(bash("run --cells 24 --integ"), Names{"--integrator"});
  EXPECT_EQ(bash("nonsense --"), Names{});
  const manual::DescribedProgram program = registered();
  EXPECT_EQ(program.commands.size(), drivers::commands().names().size());
  for (const manual::DescribedCommand& command : program.commands)
    EXPECT_EQ(bash(command.name + " --"), names_of(manual::long_flags(command.options)))
        << command.name;
}

TEST_F(CompletionsTest, BashCompletesValues) {
  write("bash");
  EXPECT_EQ(bash("run --integrator ''"), names_of(backends::integrators().names()));
  EXPECT_EQ(bash("run --integrator = ''"), names_of(backends::integrators().names()));
  EXPECT_EQ(bash("run --integrator ="), names_of(backends::integrators().names()));
  EXPECT_EQ(bash("run --integrator = eu"), Names{"euler"});
  EXPECT_EQ(bash("compare --integrators euler,i"), Names{"euler,ida"});
  EXPECT_EQ(bash("run --keep f"), Names{"first"});
  EXPECT_EQ(bash("run --out ''"), Names{"<dirnames>"});
  EXPECT_EQ(bash("run --config ''"), Names{"<default>"});
  EXPECT_EQ(bash("run --cells ''"), Names{});
  EXPECT_EQ(bash("completions ''"), (Names{"bash", "fish", "zsh"}));
}

TEST_F(CompletionsTest, BashCompletesArguments) {
  write("bash");
  EXPECT_EQ(bash("data ''"), (Names{"check", "compare", "draw"}));
  EXPECT_EQ(bash("data check ''"), Names{"<dirnames>"});
  EXPECT_EQ(bash("data --seed 1 --facts = x check ''"), Names{"<dirnames>"});
  EXPECT_EQ(bash("data --quiet ch"), Names{"check"});
  Names all = names_of(studies::studies().names());
  all.insert("all");
  EXPECT_EQ(bash("verify mass --quick ''"), all);
  EXPECT_EQ(bash("run ''"), bash("run --")) << "no argument: options are all there is";
}

TEST_F(CompletionsTest, ZshCompletes) {
  write("zsh");
  EXPECT_EQ(zsh("ru"), names_of([] {
              std::vector<std::string> all = drivers::commands().names();
              all.insert(all.end(), {"--help", "--version"});
              return all;
            }()));
  for (const manual::DescribedCommand& command : registered().commands)
    EXPECT_EQ(zsh(command.name + " --"), names_of(manual::long_flags(command.options)))
        << command.name;
  EXPECT_EQ(zsh("run --integrator ''"), names_of(backends::integrators().names()));
  EXPECT_EQ(zsh("run --integrator="), names_of(backends::integrators().names()));
  EXPECT_EQ(zsh("data ''"), (Names{"check", "compare", "draw"}));
  EXPECT_EQ(zsh("data --quiet check ''"), Names{"<files -/>"});
  EXPECT_EQ(zsh("run --config ''"), Names{"<files >"});
  EXPECT_EQ(zsh("run --cells ''"), Names{});
}

TEST_F(CompletionsTest, FishCompletes) {
  write("fish");
  EXPECT_EQ(fish("ru"), Names{"run"});
  EXPECT_EQ(fish("run --integ"), Names{"--integrator"});
  EXPECT_EQ(fish("run --integrator "), names_of(backends::integrators().names()));
  EXPECT_EQ(fish("compare --integrators euler,i"), Names{"euler,ida"});
  EXPECT_EQ(fish("run --config scr"), Names{"script"});
  EXPECT_EQ(fish("run --cells "), Names{});
  for (const manual::DescribedCommand& command : registered().commands)
    EXPECT_EQ(fish(command.name + " --"), names_of(manual::long_flags(command.options)))
        << command.name;
}

// A placeholder in the help stands for a list, words, files, folders, a number or free text.
TEST(Completions, EveryPlaceholderIsKnown) {
  const Names others = {"TEXT",    "NUMBER", "NUMBER,...", "NUMBER,NUMBER", "INT", "UINT", "FLOAT",
                        "INT,...", ""};
  std::size_t lists = 0;
  for (const manual::DescribedCommand& command : registered().commands)
    for (const auto* options : {&command.positionals, &command.options})
      for (const manual::DescribedOption& option : *options) {
        const bool known = manual::offered_values(option.placeholder).kind !=
                           manual::OfferedValues::Kind::anything;
        lists += known;
        EXPECT_TRUE(known || others.count(option.placeholder) > 0)
            << command.name << " " << option.help << ": " << option.placeholder;
      }
  EXPECT_GT(lists, 50u);
}

// Names that are offered are taken.
TEST(Completions, WordsAreAccepted) {
  const manual::DescribedProgram program = registered();
  std::size_t accepted = 0;
  for (const manual::DescribedOption& option : program.commands.front().options) {
    if (option.placeholder.find('|') == std::string::npos) continue;
    for (const auto& [word, meaning] : manual::offered_values(option.placeholder).values) {
      const ProgramEnd end =
          traceraft("run --validate --quiet --case two-rafts --cells 32 --epsilon 1 " +
                    std::string(option.flags.front() == "--keep" ? "--integrator euler " : "") +
                    option.flags.front() + " " + word);
      EXPECT_EQ(end.code, 0) << option.flags.front() << " " << word << ": " << end.output;
      ++accepted;
    }
  }
  EXPECT_EQ(accepted, 13u) << "of --model, --mesh, --potential, --keep and --energy-guard";
}

TEST(Completions, UnknownShellsAreAnswered) {
  const ProgramEnd end = traceraft("completions bush");
  EXPECT_EQ(end.code, 2);
  EXPECT_EQ(end.output,
            "traceraft: unknown shell 'bush'; did you mean 'bash'? Valid: bash, zsh, fish\n");
  EXPECT_EQ(traceraft("completions").code, 2);
}

// Text of options that a shell could execute stays text.
TEST(Completions, ScriptsExecuteNothing) {
  for (const std::string& text : testing::hostile_texts()) {
    if (text.find('\0') != std::string::npos) continue;
    manual::DescribedOption option;
    option.flags = {"--" + text};
    option.placeholder = "a|" + text;
    option.help = text;
    const manual::DescribedProgram program{
        "traceraft", text, text, {option}, {{text, text, text, {}, {option}}}};
    for (const auto& [name, begin] : {std::pair("bash", "bash"), std::pair("zsh", "zsh -f"),
                                      std::pair("fish", "fish --no-config")}) {
      const TemporaryFolder folder;
      const std::string before =
          std::string(name) == "zsh" ? "words=(traceraft x) CURRENT=2\n_describe() { :; }\n" : "";
      posix::write_durably(folder.path / "script",
                           before + "cd " + folder.path.string() + "\n" +
                               manual::shells().find(name).completions(program));
      const ProgramEnd end = shell(std::string(begin) + " " + (folder.path / "script").string());
      EXPECT_EQ(end.code, 0) << name << ": " << text << "\n" << end.output;
      EXPECT_EQ(folder.entries(), 1u) << name << " executed a command: " << text;
    }
  }
}

}  // namespace
}  // namespace traceraft
