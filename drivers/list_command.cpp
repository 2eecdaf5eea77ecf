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

namespace traceraft::drivers {
namespace {

template <class Entry>
void print_list(const char* title, const NamedList<Entry>& list) {
  text::say("%s\n", title);
  for (const Entry& entry : list) text::say("  %-14s %s\n", entry.name, entry.summary);
  text::say("\n");
}

template <class Entry>
void print_list_with_parameters(const char* title, const NamedList<Entry>& list) {
  text::say("%s\n", title);
  for (const Entry& entry : list) {
    text::say("  %-14s %s\n", entry.name, entry.summary);
    if constexpr (std::is_same_v<Entry, effects::EffectEntry>)
      if (!entry.reversed.empty()) text::say("  %-14s (negative: %s)\n", "", entry.reversed);
    for (const ParameterSpec& p : entry.parameters)
      text::say("  %-14s   :%s=%s  %s [%s], %s to %s\n", "", p.name, format_number(p.default_value),
                p.meaning, p.unit.empty() ? "1" : p.unit, format_number(p.min),
                format_number(p.max));
  }
  text::say("\n");
}

int print_lists() {
  print_list("Cases (--case)", config::cases());
  print_list_with_parameters("Surfaces (--surface)", geometry::surfaces());
  text::say("  %-14s %s\n\n", "formula", "any level set, given by --surface-formula");
  print_list_with_parameters("Mobility laws (--mobility)", physics::mobilities());
  print_list_with_parameters("Effects (--effect)", effects::effects());
  print_list_with_parameters(
      "Initial states (--initial, with --initial-formula, --initial-caps, --raft-fraction and "
      "--seed)",
      problem::initial_fields());
  text::say("  %-14s %s\n\n", "restart:DIR", "the last state of the run in DIR, on the same mesh");
  print_list("Integrators (--integrator)", backends::integrators());
  print_list("Linear solvers (--linear-solver)", backends::linear_solvers());
  print_list("Studies (verify)", studies::studies());
  return kSuccess;
}

}  // namespace

Command list_command() {
  return {"list", "list cases, surfaces, laws and methods", Ranks::one,
          [](CLI::App&) { return print_lists; }};
}

}  // namespace traceraft::drivers
