#include "drivers/run/finished_run.hpp"

#include <charconv>

#include "drivers/input/json_file.hpp"
#include "drivers/run/checkpoint_store.hpp"
#include "drivers/run/summary.hpp"

namespace traceraft::run {

bool run_finished(const std::filesystem::path& run_folder) {
  const std::filesystem::path summary = run_folder / "summary.json";
  return std::filesystem::exists(summary) && input::from_json(summary, [](const input::Json& json) {
           return json.at("end").get<std::string>() == "finished";
         });
}

namespace {

TableExtent extent_in(const input::Json& table) {
  const std::string digits = table.at("crc32");
  std::uint32_t checksum = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), checksum, 16);
  if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size())
    throw DamagedFile("the summary of a run is damaged: '" + digits + "' is not a checksum");
  return {table.at("bytes").get<std::uint64_t>(), checksum};
}

}  // namespace

void require_whole_tables(const std::filesystem::path& run_folder) {
  const std::filesystem::path summary = run_folder / "summary.json";
  if (!std::filesystem::exists(summary)) return;
  const TableExtents extents = input::from_json(summary, [](const input::Json& json) {
    TableExtents extents;
    if (json.at("end") == "finished" && json.contains("tables"))
      for (const auto& [name, table] : json["tables"].items()) extents[name] = extent_in(table);
    return extents;
  });
  for (const auto& [name, extent] : extents) {
    const std::filesystem::path table = run_folder / name;
    if (!std::filesystem::exists(table)) continue;
    require_extent(table, extent);
    if (std::filesystem::file_size(table) != extent.bytes)
      throw DamagedFile(table.string() + " is damaged: it has more rows than the run wrote");
  }
}

void require_own_configuration(const std::filesystem::path& run_folder,
                               const config::Configuration& configuration) {
  const std::filesystem::path summary = run_folder / "summary.json";
  if (!std::filesystem::exists(summary)) return;
  const auto stated = input::from_json(
      summary, [](const input::Json& json) { return json.value(kConfiguration, std::string()); });
  if (!stated.empty() && stated != configuration_checksum(configuration))
    throw DamagedFile((run_folder / "config.toml").string() +
                      " is not that of its run: options have changed; restore it");
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
