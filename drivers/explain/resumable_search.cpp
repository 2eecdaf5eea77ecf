#include "drivers/explain/resumable_search.hpp"

#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/search_file.hpp"
#include "drivers/numerical_failure.hpp"

namespace traceraft {

Explanation search_resumably(const std::filesystem::path& folder, ExplainSetup& setup) {
  const SearchFile file(folder, setup);
  ExplainRequest& request = setup.request;
  request.save = [&](const SearchState& state) {
    file.save(state);
    if (state.next == SearchStep::confirm) write_explanation(folder, state.so_far, setup);
  };
  const Explanation found = numerically(
      [&] { return explain_fields(setup.series, request, file.load().value_or(SearchState{})); });
  request.save = nullptr;
  write_explanation(folder, found, setup);
  return found;
}

}  // namespace traceraft
