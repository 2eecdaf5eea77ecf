#include "drivers/explain/resumable_search.hpp"

#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/search_file.hpp"
#include "drivers/numerical_failure.hpp"
#include "verification/explain/search/rerun.hpp"

namespace traceraft {

Explanation search_resumably(const std::filesystem::path& folder, ExplainSetup& setup) {
  const SearchFile file(folder, setup);
  std::optional<SearchState> search = file.load();
  ExplainRequest& request = setup.request;
  request.save = [&](const SearchState& state) {
    search = state;
    file.save(state);
  };
  Explanation found = numerically([&] { return explain_fields(setup.series, request, search); });
  request.save = nullptr;
  if (is_to_run_again(found) && !found.rerun) {
    write_explanation(folder, found, setup);
    if (request.progress) request.progress("once more, on another mesh, by another integrator");
    run_again(setup.series, request, found);
    search->so_far.finding = found.finding;
    search->so_far.rerun = found.rerun;
    file.save(*search);
  }
  write_explanation(folder, found, setup);
  return found;
}

}  // namespace traceraft
