// The words of a page about where its numbers come from.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/config/configuration.hpp"
#include "drivers/output/page.hpp"

namespace traceraft::output {

// All settings of a run, with what they mean.
void add_settings(Page& page, const config::Configuration& configuration);

// A command with the flags that make the configuration from the defaults.
std::string command_for(const std::string& command, const config::Configuration& configuration);

// The version, the folder, and the command that makes it again.
void add_provenance(Page& page, const std::filesystem::path& folder, const std::string& command);

}  // namespace traceraft::output
