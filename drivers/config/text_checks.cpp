#include "drivers/config/text_checks.hpp"

#include <algorithm>

#include "drivers/config/options.hpp"

namespace traceraft::config {
namespace {

bool may_be_empty(const CLI::Option& option) {
  const std::vector<std::string>& names = option.get_lnames();
  const std::vector<OptionSpec>& all = run_options();
  return !names.empty() && std::any_of(all.begin(), all.end(), [&](const OptionSpec& spec) {
    return spec.name == names.front() && spec.kind == OptionKind::text && spec.words.empty();
  });
}

}  // namespace

void refuse_empty_texts(CLI::App& command) {
  const CLI::Validator filled(
      [](std::string& text) -> std::string {
        return text.empty() ? "it is empty; give a value, or leave it out" : "";
      },
      "");
  for (CLI::Option* option : command.get_options())
    if (option->get_expected_max() > 0 && !may_be_empty(*option)) option->check(filled);
}

}  // namespace traceraft::config
