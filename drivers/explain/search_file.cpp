#include "drivers/explain/search_file.hpp"

#include "backends/sodium/seal.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/explain/search_json.hpp"
#include "drivers/output/program.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

std::vector<double> numbers_of(const Vec& values) {
  return {values.begin(), values.end()};
}

// Maps of many snapshots.
constexpr std::uint64_t kMaxSearchBytes = 1 << 30;

// Of everything that the search depends on.
std::string fingerprint_of(const ExplainSetup& setup) {
  const ExplainRequest& request = setup.request;
  Json all = {{"program", program_checksum()},
              {"model", config_text(Configuration(setup.model, {}))},
              {"without", request.without},
              {"effects", request.most_effects},
              {"replicates", request.filter.replicates},
              {"pace_doubt", request.filter.pace_doubt},
              {"blur", request.blur_stated ? Json(request.filter.blur) : Json()}};
  for (const FieldSeries& series : setup.series)
    for (const FieldSnapshot& snapshot : series.snapshots) {
      Json points = Json::array();
      for (const Point& x : snapshot.points) points.push_back(numbers_of(x));
      all["data"].push_back({series.vesicle, snapshot.time, points, numbers_of(snapshot.values),
                             numbers_of(snapshot.deviation)});
    }
  return sha256(all.dump());
}

}  // namespace

SearchFile::SearchFile(const std::filesystem::path& folder, const ExplainSetup& setup)
    : path_(folder / "search.json"), setup_(setup), fingerprint_(fingerprint_of(setup)) {}

std::optional<SearchState> SearchFile::load() const {
  if (!std::filesystem::exists(path_)) return {};
  return from_json(
      path_,
      [this](const Json& json) {
        if (json.at("fingerprint") != fingerprint_)
          throw InputError("--out: " + path_.parent_path().string() +
                           " holds a search of other data, another model or other settings, or by "
                           "another build of the program; choose another folder");
        return std::optional(search_from(json, setup_.request.base));
      },
      kMaxSearchBytes);
}

void SearchFile::save(const SearchState& state) const {
  Json json = search_json(state);
  json["fingerprint"] = fingerprint_;
  write_durably(path_, json.dump() + "\n");
}

}  // namespace traceraft
