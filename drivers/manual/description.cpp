#include "drivers/manual/description.hpp"

#include <CLI/CLI.hpp>

namespace traceraft::manual {
namespace {

std::vector<std::string> flags_of_option(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& letter : option.get_snames()) flags.push_back("-" + letter);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

// "INT:INT in [1 - 100]": CLI11 joins the type and what its checks say of themselves.
void set_value(DescribedOption& described, const std::string& type) {
  const std::size_t colon = type.find(':');
  described.placeholder = type.substr(0, colon);
  if (colon == std::string::npos) return;
  described.range = type.substr(colon + 1);
  if (const std::string again = described.placeholder + " ";
      described.range.compare(0, again.size(), again) == 0)
    described.range.erase(0, again.size());
}

DescribedOption describe_option(const CLI::Option& option) {
  DescribedOption described;
  described.name = option.get_positional() ? option.get_single_name() : "";
  described.flags = flags_of_option(option);
  if (option.get_expected_max() > 0) {
    set_value(described, option.get_type_name());
    described.default_text = option.get_default_str();
    described.repeated = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  }
  described.group = option.get_group();
  described.help = option.get_description();
  described.required = option.get_required();
  for (const CLI::Option* other : option.get_excludes())
    described.excludes.push_back(other->get_name());
  return described;
}

DescribedCommand describe_command(const CLI::App& command) {
  DescribedCommand described{
      command.get_name(), command.get_description(), command.get_footer(), {}, {}};
  for (const CLI::Option* option : command.get_options())
    (option->get_positional() ? described.positionals : described.options)
        .push_back(describe_option(*option));
  return described;
}

}  // namespace

DescribedProgram describe(const CLI::App& program) {
  const DescribedCommand top = describe_command(program);
  DescribedProgram described{top.name, top.summary, top.footer, top.options, {}};
  for (const CLI::App* command : program.get_subcommands({}))
    described.commands.push_back(describe_command(*command));
  return described;
}

}  // namespace traceraft::manual
