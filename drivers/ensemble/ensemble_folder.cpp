#include "drivers/ensemble/ensemble_folder.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "drivers/config/config_file.hpp"
#include "drivers/config/options.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/json_members.hpp"
#include "drivers/run/finished_run.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::ensemble {
namespace {

// Advice for damaged runs. One that may only be unreadable for the moment is not to be deleted.
std::string with_advice(const std::string& why, const std::filesystem::path& run) {
  return "delete " + run.string() + " to repeat the run: " + why;
}

// Throws DamagedFile unless a run has the options of the ensemble, and its own seed.
void require_options(const std::filesystem::path& run, const config::Configuration& ensemble,
                     std::uint64_t seed) {
  const config::Configuration own(config::read_config_file(run / "config.toml"), {});
  std::vector<std::string> names = config::differing_options(ensemble, own);
  names.erase(std::remove(names.begin(), names.end(), "seed"), names.end());
  if (own.options().seed != static_cast<std::int64_t>(seed)) names.emplace_back("seed");
  if (!names.empty())
    throw DamagedFile("its config.toml differs from that of the ensemble in " +
                      joined(names, " and "));
}

}  // namespace

std::vector<std::uint64_t> EnsemblePlan::seeds() const {
  std::vector<std::uint64_t> all(static_cast<std::size_t>(runs));
  std::iota(all.begin(), all.end(), first_seed);
  return all;
}

template <class Members>
void describe(Members& members, EnsemblePlan& plan) {
  members("runs", plan.runs, input::WithinRange{1, kMostRuns});
  members("first_seed", plan.first_seed, input::WithinRange{0, config::kLargestSeed});
}

void EnsembleFolder::save(const EnsemblePlan& plan) const {
  input::write_json(plan_file(), input::object_of(plan));
}

void EnsembleFolder::refuse_other_plan() const {
  if (!std::filesystem::exists(plan_file())) return;
  try {
    (void)load();
  } catch (const IoError&) {
    refuse_plan();
  }
}

void EnsembleFolder::refuse_plan() const {
  throw InputError(plan_file().string() + " is not the plan of an ensemble; choose another folder");
}

EnsemblePlan EnsembleFolder::load() const {
  const bool of_ensemble = input::from_json(plan_file(), [](const input::Json& json) {
    return !json.is_object() || json.contains("first_seed");  // else a plan of another command
  });
  if (!of_ensemble) refuse_plan();
  return input::read_object<EnsemblePlan>(plan_file());
}

std::filesystem::path EnsembleFolder::run_of(std::uint64_t seed) const {
  return path_ / "runs" / ("seed-" + std::to_string(seed));
}

std::filesystem::path EnsembleFolder::log_of(std::uint64_t seed) const {
  return path_ / "runs" / ("seed-" + std::to_string(seed) + ".log");
}

EnsembleFolder::Member EnsembleFolder::member(std::uint64_t seed) const {
  const std::filesystem::path run = run_of(seed), summary = run / "summary.json";
  if (!std::filesystem::exists(run / "config.toml")) return {MemberEnd::missing, ""};
  if (!std::filesystem::exists(summary)) return {MemberEnd::begun, ""};
  try {
    return input::from_json(summary, [](const input::Json& json) -> Member {
      const std::string end = json.at("end");
      if (end == "failed") return {MemberEnd::failed, json.value("why", std::string())};
      return {end == "finished" ? MemberEnd::finished : MemberEnd::begun, ""};
    });
  } catch (const DamagedFile& error) {
    return {MemberEnd::failed, with_advice(error.what(), run)};
  } catch (const IoError& error) {
    return {MemberEnd::failed, error.what()};
  }
}

double EnsembleFolder::reached(std::uint64_t seed) const {
  // A row that is being written, or none: it is for the progress shown alone.
  constexpr std::streamoff kTail = 4096;
  std::ifstream file(run_of(seed) / "series.csv", std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  std::string text(static_cast<std::size_t>(std::min(size, kTail)), '\0');
  file.seekg(size - static_cast<std::streamoff>(text.size()));
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.erase(text.rfind('\n') + 1);
  if (!file || text.size() < 2) return 0;
  const std::size_t row = text.rfind('\n', text.size() - 2) + 1;  // 0: the heading
  const std::size_t comma = text.find(',', row);
  return row == 0 || comma == std::string::npos ? 0
                                                : std::strtod(text.c_str() + comma + 1, nullptr);
}

observations::History EnsembleFolder::history(std::uint64_t seed, double radius) const {
  run::require_whole_tables(run_of(seed));
  const input::CsvTable series = input::CsvTable::read(run_of(seed) / "series.csv");
  observations::History history;
  history.time = series.numbers("t");
  history.of(observations::Quantity::perimeter) = series.numbers("perimeter");
  for (double& perimeter : history.of(observations::Quantity::perimeter)) perimeter /= radius;
  history.of(observations::Quantity::rafts) = series.numbers("rafts");
  history.of(observations::Quantity::fraction) = series.numbers("raft_fraction");
  return history;
}

FinishedMembers finished_members(const EnsembleFolder& folder,
                                 const config::Configuration& configuration) {
  constexpr double kRoundoff = 1e-9;
  const double t_end = configuration.options().t_end, radius = configuration.units().length();
  FinishedMembers result;
  const auto damaged = [&](std::uint64_t seed, const std::string& why) {
    result.damaged.push_back({seed, with_advice(why, folder.run_of(seed))});
  };
  for (const std::uint64_t seed : folder.load().seeds()) {
    if (folder.member(seed).end != MemberEnd::finished) continue;
    try {
      require_options(folder.run_of(seed), configuration, seed);
      observations::History history = folder.history(seed, radius);
      const double last = history.time.empty() ? 0 : history.time.back();
      if (last < (1 - kRoundoff) * t_end) {
        damaged(seed, "its series.csv ends at t = " + format_number(last) + " instead of " +
                          format_number(t_end));
        continue;
      }
      result.seeds.push_back(seed);
      result.histories.push_back(std::move(history));
    } catch (const InputError& error) {
      damaged(seed, error.what());
    } catch (const DamagedFile& error) {
      damaged(seed, error.what());
    } catch (const IoError& error) {
      if (std::filesystem::exists(folder.run_of(seed) / "series.csv"))
        result.damaged.push_back({seed, error.what()});
      else
        damaged(seed, error.what());
    }
  }
  return result;
}

}  // namespace traceraft::ensemble
