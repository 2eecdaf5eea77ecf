#include <CLI/CLI.hpp>

#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/manual/manual_page.hpp"
#include "drivers/text/say.hpp"
#include "drivers/version.hpp"

namespace traceraft::manual {
namespace {

drivers::Action define_man(CLI::App& app) {
  app.footer("Example: traceraft man | man -l -");
  // The whole program: what is defined later is part of it, too.
  return [program = app.get_parent()] {
    text::say_encoded(manual_page(describe(*program), kVersion, kReleaseDate));
    return drivers::kSuccess;
  };
}

}  // namespace

drivers::Command man_command() {
  return {"man", "write the manual page, in roff", drivers::Ranks::one, define_man};
}

}  // namespace traceraft::manual
