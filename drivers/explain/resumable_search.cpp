#include "drivers/explain/resumable_search.hpp"

#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/search_file.hpp"
#include "drivers/explain/search_time_left.hpp"
#include "drivers/numerical_failure.hpp"
#include "drivers/output/status_line.hpp"
#include "kernel/core/stopwatch.hpp"

namespace traceraft::explain {
namespace {

void tell(const selection::ExplainRequest& request, const output::TimeLeft::Range& left) {
  if (left.high > 0 && request.progress)
    request.progress("  " + output::clock_text(left.low) + " to " + output::clock_text(left.high) +
                     " left, depending on what is found");
}

}  // namespace

selection::Explanation search_resumably(const std::filesystem::path& folder, ExplainSetup& setup) {
  const SearchFile file(folder, setup);
  selection::ExplainRequest& request = setup.request;
  const selection::SearchState from =
      drivers::numerically([&] { return file.load().value_or(selection::SearchState{}); });
  const Stopwatch watch;
  SearchTimeLeft left(request.most_effects);
  (void)left.note(from, 0);
  request.save = [&](const selection::SearchState& state) {
    file.save(state);
    if (state.refits.empty()) tell(request, left.note(state, watch.seconds()));
    if (state.next == selection::SearchStep::confirm)
      write_explanation(folder, state.so_far, setup);
  };
  const selection::Explanation found =
      drivers::numerically([&] { return selection::explain_fields(setup.series, request, from); });
  request.save = nullptr;
  write_explanation(folder, found, setup);
  return found;
}

}  // namespace traceraft::explain
