#include "drivers/run/finished_run.hpp"

#include <charconv>
#include <optional>

#include "drivers/input/json_file.hpp"
#include "drivers/run/checkpoint_store.hpp"

namespace traceraft::run {

bool run_finished(const std::filesystem::path& run_folder) {
  const std::filesystem::path summary = run_folder / "summary.json";
  return std::filesystem::exists(summary) && input::from_json(summary, [](const input::Json& json) {
           return json.at("end").get<std::string>() == "finished";
         });
}

namespace {

TableExtent extent_in(const input::Json& tables, const std::string& name) {
  const input::Json& table = tables.at(name);
  const std::string digits = table.at("crc32");
  std::uint32_t checksum = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), checksum, 16);
  if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size())
    throw DamagedFile("the summary of a run is damaged: '" + digits + "' is not a checksum");
  return {table.at("bytes").get<std::uint64_t>(), checksum};
}

}  // namespace

void require_whole_table(const std::filesystem::path& run_folder, const std::string& name) {
  if (!run_finished(run_folder)) return;
  const auto extent = input::from_json(run_folder / "summary.json",
                                       [&](const input::Json& json) -> std::optional<TableExtent> {
                                         if (!json.contains("tables")) return std::nullopt;
                                         return extent_in(json["tables"], name);
                                       });
  if (extent) require_extent(run_folder / name, *extent);
}

double summary_number(const std::filesystem::path& run_folder, const char* name) {
  return input::from_json(run_folder / "summary.json",
                          [&](const input::Json& json) { return json.at(name).get<double>(); });
}

Vec concentration_at_end(const std::filesystem::path& run_folder, int nodes) {
  const Checkpoint last = CheckpointStore(run_folder / "checkpoints").newest();
  if (static_cast<double>(last.step) != summary_number(run_folder, "steps"))
    throw IoError(run_folder.string() +
                  " has lost its last checkpoint; delete this folder to repeat the run");
  return concentration_of(last, run_folder, nodes);
}

}  // namespace traceraft::run
