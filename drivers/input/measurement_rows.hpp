// The rows of a table of measurements: one per look at a vesicle, or one per raft of a look.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/input/csv_table.hpp"
#include "verification/observations/measurements.hpp"

namespace traceraft::input {

// The factors that turn the numbers of a table into µm, s and standard deviations.
struct TableUnits {
  double length = 1, time = 1, time_offset = 0;
  std::optional<double> radius;  // µm, of all vesicles
  double sigmas = 1;             // standard deviations in what the table calls sigma
};

// The measurements of all looks, in the order of the rows. Throws InputError with file, line and
// column for what is missing, unknown, impossible or contradicts itself.
std::vector<observations::Measurement> read_measurements(const TableUnits& units,
                                                         const CsvTable& table);

}  // namespace traceraft::input
