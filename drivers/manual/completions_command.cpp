#include <CLI/CLI.hpp>
#include <memory>

#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/manual/completions.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::manual {
namespace {

drivers::Action define_completions(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  app.add_option("shell", *shell, "whose language the completions are written in")
      ->type_name(joined(shells().names(), "|"))
      ->required();
  app.footer("Example: source <(traceraft completions bash)");
  return [shell, program = app.get_parent()] {
    text::say_encoded(shells().find(*shell).completions(describe(*program)));
    return drivers::kSuccess;
  };
}

}  // namespace

const NamedList<ShellEntry>& shells() {
  static const NamedList<ShellEntry> list("shell", {bash_shell(), zsh_shell(), fish_shell()});
  return list;
}

drivers::Command completions_command() {
  return {"completions", "write what completes this command line in a shell", drivers::Ranks::one,
          define_completions};
}

}  // namespace traceraft::manual
