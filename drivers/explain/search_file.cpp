#include "drivers/explain/search_file.hpp"

#include <cmath>

#include "backends/sodium/seal.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/explain/search_json.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {
namespace {

std::vector<double> numbers_of(const Vec& values) {
  return {values.begin(), values.end()};
}

// Maps of many snapshots.
constexpr std::uint64_t kMaxSearchBytes = 1 << 30;

std::string checksum_of(const std::vector<FieldSeries>& data) {
  Json all = Json::array();
  for (const FieldSeries& series : data)
    for (const FieldSnapshot& snapshot : series.snapshots) {
      Json points = Json::array();
      for (const Point& x : snapshot.points) points.push_back(numbers_of(x));
      all.push_back({series.vesicle, snapshot.time, points, numbers_of(snapshot.values),
                     numbers_of(snapshot.deviation)});
    }
  return sha256(all.dump());
}

// Everything that the search depends on, by the words for it.
Json subject_of(const ExplainSetup& setup) {
  const ExplainRequest& request = setup.request;
  return {{"the build of the program", program_checksum()},
          {"the model", config_text(setup.configuration)},
          {"the data", checksum_of(setup.series)},
          {"the blur of the data", request.blur_stated ? Json(request.filter.blur) : Json()},
          {"the noise of the data",
           {request.filter.correlation.length(), request.filter.correlation.share()}},
          {"--without", request.without},
          {"--most-effects", request.most_effects},
          {"--replicates", request.filter.replicates},
          {"--diffusion-error",
           std::isfinite(request.filter.pace_doubt) ? Json(request.filter.pace_doubt) : Json()}};
}

std::string differences(const Json& saved, const Json& subject) {
  std::vector<std::string> words;
  for (const auto& [word, value] : subject.items())
    if (saved.at(word) != value) words.push_back(word);
  return joined(words, ", ");
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what) {
  throw DamagedFile(path.string() + " is damaged: " + what);
}

// Everything that is counted by the data: vesicles, their snapshots, and rounds that are over.
void check_against_data(const std::filesystem::path& path, const SearchState& state,
                        const std::vector<FieldSeries>& series) {
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
  for (const Disagreement& d : state.so_far.disagreements) check(d.vesicle, 0);
  for (const FrameChange& change : state.so_far.frames) check(change.vesicle, change.snapshot);
  for (const DisagreementMaps* maps : {&state.so_far.base_maps, &state.so_far.found_maps})
    for (const DisagreementMap& map : maps->snapshots) {
      check(map.vesicle, 0);
      if (map.z.size() != maps->snapshots.front().z.size())
        refuse(path, "its maps are of different meshes");
    }
  const bool early = state.next == SearchStep::start || state.next == SearchStep::calibrate ||
                     state.next == SearchStep::screen;
  if (!early && state.so_far.rounds.empty()) refuse(path, "a round is missing");
  if (!(state.so_far.found.pace > 0)) refuse(path, "its D is not positive");
}

}  // namespace

SearchFile::SearchFile(const std::filesystem::path& folder, const ExplainSetup& setup)
    : path_(folder / "search.json"), setup_(setup), subject_(subject_of(setup)) {}

std::optional<SearchState> SearchFile::load() const {
  if (!std::filesystem::exists(path_)) return {};
  return from_json(
      path_,
      [this](const Json& json) {
        const std::string words = json.contains("subject") ? differences(json["subject"], subject_)
                                                           : "the version of the program";
        if (!words.empty())
          throw InputError("--out: " + path_.parent_path().string() +
                           " holds a search that differs in " + words + "; choose another folder");
        SearchState state = search_from(json, setup_.request.base);
        check_against_data(path_, state, setup_.series);
        return std::optional(std::move(state));
      },
      kMaxSearchBytes);
}

void SearchFile::save(const SearchState& state) const {
  Json json = search_json(state);
  json["subject"] = subject_;
  write_durably(path_, json.dump() + "\n");
}

}  // namespace traceraft
