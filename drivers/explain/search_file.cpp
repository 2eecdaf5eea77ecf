#include "drivers/explain/search_file.hpp"

#include <cmath>

#include "backends/sodium/seal.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/explain/search_json.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::explain {
namespace {

std::vector<double> numbers_of(const Vec& values) {
  return {values.begin(), values.end()};
}

// Maps of many snapshots.
constexpr std::uint64_t kMaxSearchBytes = 1 << 30;

std::string checksum_of(const std::vector<assimilation::FieldSeries>& data) {
  input::Json all = input::Json::array();
  for (const assimilation::FieldSeries& series : data)
    for (const assimilation::FieldSnapshot& snapshot : series.snapshots) {
      input::Json points = input::Json::array();
      for (const Point& x : snapshot.points) points.push_back(numbers_of(x));
      all.push_back({series.vesicle, snapshot.time, points, numbers_of(snapshot.values),
                     numbers_of(snapshot.deviation)});
    }
  return sodium::sha256(all.dump());
}

// Everything that the search depends on, by the words for it.
input::Json subject_of(const ExplainSetup& setup) {
  const selection::ExplainRequest& request = setup.request;
  return {{"the build of the program", output::program_checksum()},
          {"the model", config::config_text(setup.configuration)},
          {"the data", checksum_of(setup.series)},
          {"the blur of the data",
           request.blur_stated ? input::Json(request.filter.blur) : input::Json()},
          {"the noise of the data",
           {request.filter.correlation.length(), request.filter.correlation.share()}},
          {"--without", request.without},
          {"--most-effects", request.most_effects},
          {"--replicates", request.filter.replicates},
          {"--diffusion-error", std::isfinite(request.filter.diffusion_ratio_doubt)
                                    ? input::Json(request.filter.diffusion_ratio_doubt)
                                    : input::Json()}};
}

std::string differences(const input::Json& saved, const input::Json& subject) {
  std::vector<std::string> words;
  for (const auto& [word, value] : subject.items())
    if (saved.at(word) != value) words.push_back(word);
  return joined(words, ", ");
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw DamagedFile(path.string() + " is damaged: " + what);
}

// Everything that is counted by the data: vesicles, their snapshots, and rounds that are over.
void check_against_data(const std::filesystem::path& path, const selection::SearchState& state,
                        const std::vector<assimilation::FieldSeries>& series) {
  const auto check = [&](std::size_t vesicle, std::size_t snapshot) {
    if (vesicle >= series.size() || snapshot >= series[vesicle].snapshots.size())
      refuse(path, "it names a snapshot that is not in the data");
  };
  if (state.so_far.noise_model.levels.size() != series.size())
    refuse(path, "the noise of a vesicle is missing");
  for (std::size_t v = 0; v < series.size(); ++v) {
    if (state.so_far.noise_model.levels[v].size() != series[v].snapshots.size())
      refuse(path, "the noise of a snapshot is missing");
    for (const double noise : state.so_far.noise_model.levels[v])
      if (!(noise > 0)) refuse(path, "a noise is not positive");
  }
  for (const assimilation::Disagreement& d : state.so_far.disagreements) check(d.vesicle, 0);
  for (const selection::FrameChange& change : state.so_far.frames)
    check(change.vesicle, change.snapshot);
  for (const assimilation::DisagreementMaps* maps :
       {&state.so_far.base_maps, &state.so_far.found_maps})
    for (const assimilation::DisagreementMap& map : maps->snapshots) {
      check(map.vesicle, 0);
      if (map.z.size() != maps->snapshots.front().z.size())
        refuse(path, "its maps are of different meshes");
    }
  const bool early = state.next == selection::SearchStep::start ||
                     state.next == selection::SearchStep::calibrate ||
                     state.next == selection::SearchStep::screen;
  if (!early && state.so_far.rounds.empty()) refuse(path, "a round is missing");
  if (!(state.so_far.found.diffusion_ratio > 0)) refuse(path, "its D is not positive");
}

}  // namespace

SearchFile::SearchFile(const std::filesystem::path& folder, const ExplainSetup& setup)
    : path_(folder / "search.json"), setup_(setup), subject_(subject_of(setup)) {}

std::optional<selection::SearchState> SearchFile::load() const {
  if (!std::filesystem::exists(path_)) return {};
  return input::from_json(
      path_,
      [this](const input::Json& json) {
        const std::string words = json.contains("subject") ? differences(json["subject"], subject_)
                                                           : "the version of the program";
        if (!words.empty())
          throw InputError("--out: " + path_.parent_path().string() +
                           " holds a search that differs in " + words + "; choose another folder");
        selection::SearchState state = search_from(json, setup_.request.base);
        check_against_data(path_, state, setup_.series);
        return std::optional(std::move(state));
      },
      kMaxSearchBytes);
}

void SearchFile::save(const selection::SearchState& state) const {
  input::Json json = search_json(state);
  json["subject"] = subject_;
  input::write_json(path_, std::move(json), -1);
}

}  // namespace traceraft::explain
