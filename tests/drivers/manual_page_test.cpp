// The manual page that the program writes, held against the options that its commands register.
#include "drivers/manual/manual_page.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "drivers/commands.hpp"
#include "drivers/manual/value_lists.hpp"
#include "drivers/text/encoders.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::ProgramEnd;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;

// The page as it is shown, or what groff has against it. Needs the Debian package groff-base.
ProgramEnd typeset(const std::string& page, const std::string& options) {
  const TemporaryFolder folder;
  posix::write_durably(folder.path / "page.1", page);
  return shell("cd " + folder.path.string() + " && groff -man -Tutf8 -ww -P-cbou " + options +
               " page.1");
}

// From one heading of a command to the next.
std::string section_of(const std::string& page, const std::string& command) {
  const std::string heading = ".SS traceraft " + text::in_roff(command) + "\n";
  const std::size_t begin = page.find(heading);
  if (begin == std::string::npos) return "";
  return page.substr(begin, page.find("\n.S", begin + heading.size()) - begin);
}

TEST(ManualPage, NamesEveryOptionOfEveryCommand) {
  const std::string page = traceraft("man").output;
  std::size_t options = 0;
  for (const drivers::Command& command : drivers::commands()) {
    CLI::App app;
    const drivers::Action action = command.define(app);
    const std::string section = section_of(page, command.name);
    EXPECT_NE(section, "") << command.name;
    for (const CLI::Option* option : app.get_options()) {
      for (const std::string& name : option->get_lnames()) {
        EXPECT_NE(section.find("\\fB" + text::in_roff("--" + name) + "\\fR"), std::string::npos)
            << command.name << " --" << name;
        ++options;
      }
      if (option->get_positional()) {
        EXPECT_NE(section.find("\\fI" + text::in_roff(option->get_single_name()) + "\\fR"),
                  std::string::npos)
            << command.name << " " << option->get_single_name();
      }
    }
  }
  EXPECT_GT(options, 200u);
}

TEST(ManualPage, ListsTheNamesThatOptionsTake) {
  const std::string page = traceraft("man").output;
  for (const manual::ValueList& list : manual::value_lists()) {
    EXPECT_NE(page.find("(" + list.name + ")\n"), std::string::npos) << list.name;
    for (const auto& [name, meaning] : list.values)
      EXPECT_NE(page.find("\n\\fB" + text::in_roff(name) + "\\fR\n"), std::string::npos) << name;
  }
}

TEST(ManualPage, IsTypesetWithoutWarnings) {
  const std::string page = traceraft("man").output;
  const ProgramEnd warnings = typeset(page, "-z");
  EXPECT_EQ(warnings.code, 0);
  EXPECT_EQ(warnings.output, "");
  const std::string shown = typeset(page, "").output;
  for (const char* line :
       {"traceraft - simulates how lipid rafts form", "--integrator INTEGRATOR",
        "--scaled, --no-scaled", "second|first|decaying", "As for traceraft: -h, --help."})
    EXPECT_NE(shown.find(line), std::string::npos) << line << "\n" << shown;
}

// Whatever is written as the help of an option stays text.
TEST(ManualPage, HelpIsText) {
  for (const std::string& text : testing::hostile_texts()) {
    manual::DescribedOption option;
    option.flags = {"--flag"};
    option.placeholder = option.default_text = option.help = option.group = text;
    const manual::DescribedProgram program{
        "name", text, text, {option}, {{text, text, text, {option}, {}}}};
    // Lines that are too long to be broken are shown all the same.
    const ProgramEnd end = typeset(manual::manual_page(program, text, text), "-z -Wbreak");
    EXPECT_EQ(end.code, 0) << text;
    EXPECT_EQ(end.output, "") << text;
  }
}

}  // namespace
}  // namespace traceraft
