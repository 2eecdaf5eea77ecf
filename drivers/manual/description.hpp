// The commands and options of the program as plain data, read from the parser that has them. The
// manual page and the completions of shells are made from it.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace traceraft::manual {

struct DescribedOption {
  std::string name;                // of a positional; "" of a flag
  std::vector<std::string> flags;  // "--fields", "--no-fields"; none of a positional
  std::string placeholder;         // of the value: "FILE"; "" if it takes none
  std::string range;               // "in [1 - 100]", or ""
  std::string default_text;        // or ""
  std::string group;               // the heading of the help that it stands under
  std::string help;
  std::vector<std::string> excludes;  // flags that it cannot be given with
  bool required = false, repeated = false;

  bool takes_value() const { return !placeholder.empty(); }
};

struct DescribedCommand {
  std::string name, summary, footer;
  std::vector<DescribedOption> positionals, options;
};

struct DescribedProgram {
  std::string name, summary, footer;
  std::vector<DescribedOption> options;  // beside those of a command: --help, --version
  std::vector<DescribedCommand> commands;
};

DescribedProgram describe(const CLI::App& program);

}  // namespace traceraft::manual
