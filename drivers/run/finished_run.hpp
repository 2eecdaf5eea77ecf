// A run that has reached its end, as its folder tells it.
#pragma once

#include <filesystem>
#include <string>

#include "drivers/config/configuration.hpp"
#include "kernel/core/types.hpp"

namespace traceraft::run {

// Has a run reached its end in this folder? Throws IoError if its summary is damaged.
bool run_finished(const std::filesystem::path& run_folder);

// Throws DamagedFile if a file of a run that has reached its end is not what its summary says that
// was written, IoError if one of them cannot be read. A file that somebody deleted is not missed.
void require_whole_tables(const std::filesystem::path& run_folder);

// Throws DamagedFile if the run of this folder had other options, as far as they change numbers.
void require_own_configuration(const std::filesystem::path& run_folder,
                               const config::Configuration& configuration);

// A number of its summary. Throws IoError if it is not there.
double summary_number(const std::filesystem::path& run_folder, const char* name);

// c at the nodes at the end of a finished run. Throws IoError unless its last checkpoint is whole.
Vec concentration_at_end(const std::filesystem::path& run_folder, int nodes);

}  // namespace traceraft::run
