#include <cstdio>
#include <type_traits>

#include "backends/list.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/cases.hpp"
#include "drivers/exit_codes.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/physics/mobility.hpp"
#include "kernel/problem/initial_data.hpp"
#include "verification/studies/studies.hpp"

namespace traceraft {
namespace {

template <class Entry>
void print_list(const char* title, const NamedList<Entry>& list) {
  std::printf("%s\n", title);
  for (const Entry& entry : list)
    std::printf("  %-14s %s\n", entry.name.c_str(), entry.summary.c_str());
  std::printf("\n");
}

template <class Entry>
void print_list_with_parameters(const char* title, const NamedList<Entry>& list) {
  std::printf("%s\n", title);
  for (const Entry& entry : list) {
    std::printf("  %-14s %s\n", entry.name.c_str(), entry.summary.c_str());
    if constexpr (std::is_same_v<Entry, EffectEntry>)
      if (!entry.reversed.empty())
        std::printf("  %-14s (negative: %s)\n", "", entry.reversed.c_str());
    for (const ParameterSpec& p : entry.parameters)
      std::printf("  %-14s   :%s=%s  %s [%s], %s to %s\n", "", p.name.c_str(),
                  format_number(p.default_value).c_str(), p.meaning.c_str(),
                  p.unit.empty() ? "1" : p.unit.c_str(), format_number(p.min).c_str(),
                  format_number(p.max).c_str());
  }
  std::printf("\n");
}

int print_lists() {
  print_list("Cases (--case)", cases());
  print_list_with_parameters("Surfaces (--surface)", surfaces());
  std::printf("  %-14s %s\n\n", "formula", "any level set, from --surface-formula");
  print_list_with_parameters("Mobility laws (--mobility)", mobilities());
  print_list_with_parameters("Effects (--effect)", effects());
  print_list_with_parameters("Initial states (--initial)", initial_fields());
  std::printf("  %-14s %s\n\n", "restart:DIR",
              "the last state of the run in DIR, on the same mesh");
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
