#include "drivers/output/provenance.hpp"

#include "drivers/config/config_file.hpp"
#include "drivers/output/program.hpp"

namespace traceraft::output {

void add_settings(Page& page, const config::Configuration& configuration) {
  std::vector<std::vector<std::string>> rows = {{"setting", "value", "meaning"}};
  for (const config::OptionSpec& spec : config::run_options())
    rows.push_back({spec.name,
                    spec.name == "noise-cells" ? std::to_string(configuration.noise_cells())
                                               : configuration.text(spec.name),
                    spec.help});
  page.heading("Settings");
  page.table(rows);
}

std::string command_for(const std::string& command, const config::Configuration& configuration) {
  const std::string flags = config::flags_text(configuration);
  return command + (flags.empty() ? "" : " ") + flags;
}

void add_provenance(Page& page, const std::filesystem::path& folder, const std::string& command) {
  page.heading("Where this comes from");
  page.paragraph(program_text() + ", from the files in " +
                 std::filesystem::absolute(folder).lexically_normal().string() +
                 ". This command repeats it:");
  page.code(command);
}

}  // namespace traceraft::output
