#include "drivers/run/finished_run.hpp"

#include "drivers/output/json_file.hpp"
#include "drivers/run/checkpoint_store.hpp"

namespace traceraft {

bool run_finished(const std::filesystem::path& run_folder) {
  const std::filesystem::path summary = run_folder / "summary.json";
  return std::filesystem::exists(summary) && from_json(summary, [](const Json& json) {
           return json.at("end").get<std::string>() == "finished";
         });
}

double summary_number(const std::filesystem::path& run_folder, const char* name) {
  return from_json(run_folder / "summary.json",
                   [&](const Json& json) { return json.at(name).get<double>(); });
}

Vec concentration_at_end(const std::filesystem::path& run_folder, int nodes) {
  const Checkpoint last = CheckpointStore(run_folder / "checkpoints").newest();
  if (static_cast<double>(last.step) != summary_number(run_folder, "steps"))
    throw IoError(run_folder.string() +
                  " has lost its last checkpoint; delete that folder to repeat the run");
  return concentration_of(last, run_folder, nodes);
}

}  // namespace traceraft
