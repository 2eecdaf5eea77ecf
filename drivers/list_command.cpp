#include <type_traits>

#include "backends/list.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/cases.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/text/say.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/physics/mobility.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

template <class Entry>
void print_list(const char* title, const NamedList<Entry>& list) {
  say("%s\n", title);
  for (const Entry& entry : list) say("  %-14s %s\n", entry.name, entry.summary);
  say("\n");
}

template <class Entry>
void print_list_with_parameters(const char* title, const NamedList<Entry>& list) {
  say("%s\n", title);
  for (const Entry& entry : list) {
    say("  %-14s %s\n", entry.name, entry.summary);
    if constexpr (std::is_same_v<Entry, EffectEntry>)
      if (!entry.reversed.empty()) say("  %-14s (negative: %s)\n", "", entry.reversed);
    for (const ParameterSpec& p : entry.parameters)
      say("  %-14s   :%s=%s  %s [%s], %s to %s\n", "", p.name, format_number(p.default_value),
          p.meaning, p.unit.empty() ? "1" : p.unit, format_number(p.min), format_number(p.max));
  }
  say("\n");
}

int print_lists() {
  print_list("Cases (--case)", cases());
  print_list_with_parameters("Surfaces (--surface)", surfaces());
  say("  %-14s %s\n\n", "formula", "any level set, given by --surface-formula");
  print_list_with_parameters("Mobility laws (--mobility)", mobilities());
  print_list_with_parameters("Effects (--effect)", effects());
  print_list_with_parameters(
      "Initial states (--initial, with --initial-formula, --initial-caps, --raft-fraction and "
      "--seed)",
      initial_fields());
  say("  %-14s %s\n\n", "restart:DIR", "the last state of the run in DIR, on the same mesh");
  print_list("Integrators (--integrator)", integrators());
  print_list("Linear solvers (--linear-solver)", linear_solvers());
  print_list("Studies (verify)", studies());
  return kSuccess;
}

}  // namespace

Command list_command() {
  return {"list", "list cases, surfaces, laws and methods", Ranks::one,
          [](CLI::App&) { return print_lists; }};
}

}  // namespace traceraft
