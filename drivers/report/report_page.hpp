// One self-contained page of what a folder holds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "drivers/report/surface_frames.hpp"
#include "verification/observations/measurements.hpp"

namespace traceraft::report {

// The run whose surface is shown: the folder itself, or the first finished one of an ensemble.
// Throws InputError if there is none.
std::filesystem::path run_to_show(const std::filesystem::path& folder);

// The concentrations of the two phases of a run.
std::pair<double, double> phases_of(const std::filesystem::path& run_folder);

// "t = 0.5 s" of each, in R^2/D of a scaled run.
std::vector<std::string> time_labels(const std::filesystem::path& run_folder,
                                     const std::vector<double>& times);

struct PageRequest {
  int frames;
  double detail;
  std::filesystem::path charts;  // folder for the charts' files; made if there is something to show
  std::optional<observations::MeasuredVesicles> data;  // shown beside a run or an ensemble
};
// Writes the page of a run or an ensemble: surface, charts, numbers, settings; those of a
// comparison and a verification have been written by their commands and are copied. Returns what is
// missing, "" if nothing. Throws InputError if the folder is none of these, and for measurements
// beside what is not in seconds, or has its page already.
std::string write_report_page(const std::filesystem::path& folder, const std::filesystem::path& out,
                              const PageRequest& request);

}  // namespace traceraft::report
