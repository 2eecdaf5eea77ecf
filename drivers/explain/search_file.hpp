// The file of what a search has found so far: one that was interrupted goes on from there.
#pragma once

#include <filesystem>
#include <optional>

#include "drivers/explain/explain_run.hpp"
#include "drivers/input/json_file.hpp"
#include "verification/selection/search/search_state.hpp"

namespace traceraft::explain {

class SearchFile {
 public:
  SearchFile(const std::filesystem::path& folder, const ExplainSetup& setup);

  // Nothing if none has been saved. Throws InputError if it belongs to other data, another model or
  // other settings, IoError if it is damaged.
  std::optional<selection::SearchState> load() const;
  void save(const selection::SearchState& state) const;  // throws IoError

 private:
  const std::filesystem::path path_;
  const ExplainSetup& setup_;
  const input::Json subject_;  // of the search
};

}  // namespace traceraft::explain
