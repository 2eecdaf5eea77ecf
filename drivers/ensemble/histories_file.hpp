// histories.csv: what the runs of an ensemble share with measurements, at common times. It is small
// enough to be kept when the runs are not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "verification/observations/history.hpp"

namespace traceraft::ensemble {

inline constexpr char kHistoriesFile[] = "histories.csv";

// Columns seed, t, perimeter (over the radius), rafts, fraction; six digits. `seeds`: of the runs.
void write_histories(const std::filesystem::path& file, const std::vector<std::uint64_t>& seeds,
                     const std::vector<observations::History>& runs,
                     const std::vector<double>& times);

// Throws InputError naming line and column if the file is no such table.
std::vector<observations::History> read_histories(const std::filesystem::path& file);

}  // namespace traceraft::ensemble
