#include "drivers/manual/manual_page.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "drivers/manual/value_lists.hpp"
#include "drivers/text/encoders.hpp"

namespace traceraft::manual {
namespace {

std::string roff_bold(const std::string& text) {
  return "\\fB" + text::in_roff(text) + "\\fR";
}

std::string roff_italic(const std::string& text) {
  return "\\fI" + text::in_roff(text) + "\\fR";
}

// Text that is filled. Lines of the source stay short; each word is encoded by itself, since any of
// them may come to stand at the beginning of a line.
std::string roff_filled(const std::string& text) {
  constexpr std::size_t kWidth = 78;
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    const std::string encoded = text::in_roff(word);
    if (!line.empty() && line.size() + 1 + encoded.size() > kWidth) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + encoded;
  }
  return line.empty() ? lines : lines + line + "\n";
}

// Text whose lines stay as they are.
std::string roff_unfilled(const std::string& text) {
  std::istringstream in(text);
  std::string lines = ".PP\n.nf\n";
  for (std::string line; std::getline(in, line);) lines += text::in_roff(line) + "\n";
  return lines + ".fi\n";
}

std::string roff_section(const std::string& title) {
  return ".SH " + text::in_roff(title) + "\n";
}

std::string roff_subsection(const std::string& title) {
  return ".SS " + text::in_roff(title) + "\n";
}

// Readers of manual pages parse the date, whose hyphens are therefore plain.
std::string plain_date(const std::string& text) {
  std::string date;
  for (const char ch : text)
    if (ch == '-' || (ch >= '0' && ch <= '9')) date += ch;
  return date;
}

std::string heading_of(const DescribedOption& option) {
  std::string heading = option.name.empty() ? "" : roff_italic(option.name);
  for (const std::string& flag : option.flags)
    heading += (heading.empty() ? "" : ", ") + roff_bold(flag);
  if (option.name.empty() && option.takes_value()) heading += " " + roff_italic(option.placeholder);
  return heading;
}

bool ends_a_sentence(const std::string& text) {
  return !text.empty() && std::string(".!?").find(text.back()) != std::string::npos;
}

// Default, range and exclusions of an option, to stand after its help.
std::string notes_on(const DescribedOption& option) {
  std::string notes;
  const auto note = [&](const std::string& text) { notes += (notes.empty() ? "" : "; ") + text; };
  if (!option.name.empty() && option.takes_value() && option.placeholder != "TEXT")
    note(option.placeholder);
  if (option.repeated) note("several are allowed");
  if (option.required) note("required");
  if (!option.range.empty()) note(option.range);
  if (!option.default_text.empty()) note("default: " + option.default_text);
  for (const std::string& other : option.excludes) note("not with " + other);
  return notes;
}

std::string paragraph_of(const DescribedOption& option) {
  const std::string notes = notes_on(option);
  std::string text = option.help;
  if (!notes.empty()) text += (text.empty() ? "" : " ") + ("(" + notes + ")");
  if (!ends_a_sentence(text)) text += ".";
  return ".TP\n" + heading_of(option) + "\n" + roff_filled(text);
}

bool same_option(const DescribedOption& a, const DescribedOption& b) {
  return a.flags == b.flags && a.help == b.help && a.placeholder == b.placeholder &&
         a.default_text == b.default_text && a.range == b.range;
}

// Options that several commands share are described with the first of these.
class OptionsDescribed {
 public:
  const std::string* command_of(const DescribedOption& option) const {
    for (const auto& [command, other] : described_)
      if (same_option(option, other)) return &command;
    return nullptr;
  }
  void add(const std::string& command, const DescribedOption& option) {
    described_.emplace_back(command, option);
  }

 private:
  std::vector<std::pair<std::string, DescribedOption>> described_;
};

std::string usage_of(const DescribedProgram& program, const DescribedCommand& command) {
  std::string line =
      roff_bold(program.name + " " + command.name) + " [" + roff_italic("OPTION") + " ...]";
  for (const DescribedOption& positional : command.positionals) {
    const std::string word = roff_italic(positional.name) + (positional.repeated ? " ..." : "");
    line += " " + (positional.required ? word : "[" + word + "]");
  }
  return ".PP\n" + line + "\n";
}

// "As for run: --cells NUMBER, --seed NUMBER."
std::string shared_options(
    const std::vector<std::pair<std::string, const DescribedOption*>>& shared) {
  std::string text;
  for (auto first = shared.begin(); first != shared.end();) {
    const auto next = std::find_if(first, shared.end(),
                                   [&](const auto& entry) { return entry.first != first->first; });
    text += ".PP\nAs for " + roff_bold(first->first) + ":\n";
    for (; first != next; ++first)
      text += heading_of(*first->second) + (first + 1 == next ? ".\n" : ",\n");
  }
  return text;
}

std::string command_section(const DescribedProgram& program, const DescribedCommand& command,
                            OptionsDescribed& described) {
  std::string summary = command.summary;
  if (!summary.empty())
    summary[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(summary[0])));
  std::string text = roff_subsection(program.name + " " + command.name) +
                     roff_filled(summary + ".") + usage_of(program, command),
              group;
  for (const DescribedOption& positional : command.positionals) text += paragraph_of(positional);
  std::vector<std::pair<std::string, const DescribedOption*>> shared;
  for (const DescribedOption& option : command.options) {
    if (const std::string* elsewhere = described.command_of(option)) {
      shared.emplace_back(*elsewhere, &option);
      continue;
    }
    described.add(command.name, option);
    if (option.group != group && option.group != "Options")
      text += ".PP\n" + text::in_roff(option.group) + ":\n";
    group = option.group;
    text += paragraph_of(option);
  }
  std::stable_sort(shared.begin(), shared.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return text + shared_options(shared) +
         (command.footer.empty() ? "" : roff_unfilled(command.footer));
}

std::string commands_section(const DescribedProgram& program) {
  std::string text = roff_section("COMMANDS");
  for (const DescribedCommand& command : program.commands)
    text += ".TP\n" + roff_bold(command.name) + "\n" + roff_filled(command.summary + ".");
  return text;
}

std::string options_section(const DescribedProgram& program) {
  std::string text = roff_section("OPTIONS");
  OptionsDescribed described;
  for (const DescribedOption& option : program.options) {
    text += paragraph_of(option);
    described.add(program.name, option);
  }
  for (const DescribedCommand& command : program.commands)
    text += command_section(program, command, described);
  return text;
}

std::string values_section() {
  std::string text = roff_section("VALUES");
  text += roff_filled(
      "Names that options take, by what stands for them above. traceraft list shows "
      "their parameters, too.");
  for (const ValueList& list : value_lists()) {
    text += roff_subsection(list.title + " (" + list.name + ")");
    for (const auto& [name, meaning] : list.values)
      text += ".TP\n" + roff_bold(name) + "\n" + roff_filled(meaning + ".");
  }
  return text;
}

std::string further_section(const DescribedProgram& program) {
  return roff_section("SEE ALSO") +
         roff_filled(
             "What the results mean, the formats of all files and the exit codes are "
             "documented in the folder share/doc/" +
             program.name +
             " of the installation: docs/guide.md, docs/formats.md, "
             "docs/exit-codes.md.");
}

}  // namespace

std::string manual_page(const DescribedProgram& program, const std::string& version,
                        const std::string& date) {
  std::string summary = program.summary;
  while (ends_a_sentence(summary)) summary.pop_back();
  if (!summary.empty())
    summary[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(summary[0])));
  return ".TH TRACERAFT 1 \"" + plain_date(date) + "\" \"" +
         text::in_roff(program.name + " " + version) + "\" \"User Commands\"\n" +
         // No hyphens in names, and no blanks that make both margins straight.
         ".nh\n.ad l\n" + roff_section("NAME") + text::in_roff(program.name) + " \\- " +
         text::in_roff(summary) + "\n" + roff_section("SYNOPSIS") + roff_bold(program.name) + " " +
         roff_italic("COMMAND") + " [" + roff_italic("OPTION") + " ...]\n.br\n" +
         roff_bold(program.name) + " [" + roff_bold("--help") + " | " + roff_bold("--version") +
         "]\n" + roff_section("DESCRIPTION") + roff_filled(program.summary) + ".PP\n" +
         roff_filled(program.footer + ".") + commands_section(program) + options_section(program) +
         values_section() + further_section(program);
}

}  // namespace traceraft::manual
