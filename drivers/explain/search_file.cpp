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
          {"the model", config_text(Configuration(setup.model, {}))},
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
        return std::optional(search_from(json, setup_.request.base));
      },
      kMaxSearchBytes);
}

void SearchFile::save(const SearchState& state) const {
  Json json = search_json(state);
  json["subject"] = subject_;
  write_durably(path_, json.dump() + "\n");
}

}  // namespace traceraft
