#include "drivers/ensemble/histories_file.hpp"

#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/output/text_table.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::ensemble {

void write_histories(const std::filesystem::path& file, const std::vector<std::uint64_t>& seeds,
                     const std::vector<observations::History>& runs,
                     const std::vector<double>& times) {
  bench::Table table{"histories", {"seed", "t"}, {}};
  for (const observations::Quantity quantity : observations::kQuantities)
    table.columns.push_back(observations::name_of(quantity).id);
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const double t : times) {
      std::vector<bench::Cell> row{std::to_string(seeds[k]), formatted("%.6g", t)};
      for (const observations::Quantity quantity : observations::kQuantities)
        row.emplace_back(formatted("%.6g", runs[k].at(quantity, t)));
      table.rows.push_back(std::move(row));
    }
  posix::write_durably(file, output::checked_csv_text(table));
}

std::vector<observations::History> read_histories(const std::filesystem::path& file) {
  const input::CsvTable table = input::CsvTable::read(file);
  table.require("seed");
  table.require("t");
  for (const observations::Quantity quantity : observations::kQuantities)
    table.require(observations::name_of(quantity).id);
  std::vector<observations::History> runs;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool same = row > 0 && table.text(row, "seed") == table.text(row - 1, "seed");
    if (!same) runs.emplace_back();
    observations::History& run = runs.back();
    const double t = table.number(row, "t");
    if (same && !(t > run.time.back()))
      throw InputError(table.where(row, "t") + ": times of a run must ascend");
    run.time.push_back(t);
    for (const observations::Quantity quantity : observations::kQuantities)
      run.of(quantity).push_back(table.number(row, observations::name_of(quantity).id));
  }
  if (runs.empty()) throw InputError(file.string() + ": no rows");
  const std::vector<double>&first = runs.front().time, &last = runs.back().time;
  if (last.size() < first.size() && std::equal(last.begin(), last.end(), first.begin()))
    throw InputError(
        file.string() +
        ": the last run ends earlier than the first one; is the end of the file missing?");
  return runs;
}

}  // namespace traceraft::ensemble
