#include "drivers/explain/explain_page.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/config/config_file.hpp"
#include "drivers/explain/explain_report.hpp"
#include "drivers/explain/explain_tables.hpp"
#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "drivers/output/chart.hpp"
#include "drivers/output/page.hpp"
#include "drivers/output/program.hpp"
#include "drivers/report/viewer.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::explain {
namespace {

namespace fs = std::filesystem;

// The most rows of the list of disagreements; the file has all.
constexpr std::size_t kMostRows = 12;

// Standard deviations at the ends of the colours.
constexpr double kColourEnd = 6;

class ExplainPage {
 public:
  ExplainPage(const fs::path& folder, const selection::Explanation& found,
              const ExplainSetup& setup)
      : folder_(folder),
        found_(found),
        setup_(setup),
        units_(setup.configuration.units()),
        page_("What the model lacks") {}

  std::string write() {
    page_.paragraph(data_text(setup_));
    page_.heading("Verdict: " + verdict_words(found_.finding, selection::class_of(found_)));
    page_.paragraph(verdict_sentence(found_));
    if (!found_.at_rest) page_.table(parameter_rows(found_, units_));
    for (const std::string& remark : remarks_on(found_, setup_)) page_.paragraph(remark);
    if (!found_.at_rest) {
      add_gaps();
      add_where();
      add_what();
      add_not_found();
    }
    add_origin();
    posix::write_durably(folder_ / "explain.html", page_.html());
    return missing_.text();
  }

 private:
  void add_origin() {
    page_.heading("Where this comes from");
    page_.paragraph(output::program_text() + ". Noise " + formatted("%.3g of c, ", found_.noise) +
                    assimilation::text_of(found_.noise_model.correlation) + ", " +
                    std::to_string(setup_.request.filter.replicates) +
                    " replicates with noise alone, " +
                    formatted("h/epsilon = %.2f.", found_.h_over_epsilon) + " The model:");
    page_.code(config::flags_text(setup_.configuration));
    if (const std::string run = command_for_found(folder_, found_, setup_); !run.empty()) {
      page_.paragraph(
          "This command runs the extended model. It starts from noise, not from the measured "
          "vesicle:");
      page_.code(run);
    }
  }

  void add_not_found() {
    page_.heading("Effects that were not found");
    page_.paragraph(
        "The table has 95 % bounds of their first parameters, to first order, when they are added "
        "to what was found." +
        chance_text());
    page_.table(bound_rows(found_, units_));
    page_.paragraph(
        "Not in the search: " + joined(not_looked_for(found_), ", ") +
        ". Rotations are corrected between snapshots; thermal noise is random and changes no "
        "forecast" +
        (sorts_by_curvature() ? "." : "; a curvature that is the same everywhere has no effect."));
  }

  // Bounds of effects that have one sign begin at 0.
  std::string chance_text() const {
    const std::vector<selection::Bound> bounds = selection::bounds_of(found_);
    const auto excluding =
        std::count_if(bounds.begin(), bounds.end(), [](const selection::Bound& bound) {
          return bound.seen && assimilation::find_candidate(bound.effect)->two_sided;
        });
    if (excluding == 0) return "";
    return formatted(
        " %d of these effects may have either sign. By chance, the bounds of one of them exclude 0 "
        "in %.0f %% of data sets.",
        static_cast<int>(excluding), 100 * (1 - std::pow(0.95, static_cast<double>(excluding))));
  }

  bool sorts_by_curvature() const {
    const auto holds = [](const std::vector<std::string>& names) {
      return std::count(names.begin(), names.end(), "curvature") > 0;
    };
    return holds(setup_.request.without) || !holds(not_looked_for(found_));
  }

  void add_gaps() {
    page_.heading("The gap, measured minus forecast");
    page_.paragraph(
        "Every snapshot is forecast from those before it. If a vesicle has four or more, its last "
        "snapshot is held out: no parameter is fitted to it. It only decides between effects that "
        "explain the other snapshots equally well.");
    page_.table(gap_rows(found_));
    bench::Chart chart{
        "measured minus forecast", "time (s)", "root mean square, in c", false, false, {}};
    chart.series = {gap_series("base model", found_.base, false)};
    if (found_.found.hypothesis.added() > 0)
      chart.series.push_back(
          gap_series("with " + found_.found.hypothesis.name(), found_.found, false));
    chart.series.push_back(gap_series("to be expected if nothing is missing", found_.found, true));
    output::add_chart(page_, chart, folder_ / "gaps", missing_);
  }

  bench::ChartSeries gap_series(const std::string& name, const selection::Refit& fit,
                                bool expected) const {
    bench::ChartSeries series{
        name, {}, setup_.series.size() > 1 ? bench::Mark::points : bench::Mark::both};
    for (const assimilation::SnapshotGap& gap : fit.snapshots)
      series.points.emplace_back(seconds(gap.vesicle, gap.snapshot),
                                 expected ? gap.expected : gap.gap);
    return series;
  }

  double seconds(std::size_t vesicle, std::size_t snapshot) const {
    return setup_.series[vesicle].snapshots[snapshot].time * units_.seconds_per_unit();
  }

  void add_where() {
    page_.heading("Places of disagreement");
    const bool both = found_.found.hypothesis.added() > 0 && !found_.found_maps.snapshots.empty();
    page_.paragraph(
        "The colours show measured minus forecast near each place, in standard deviations of "
        "noise: orange where more raft was measured, blue where less. Noise alone exceeds " +
        formatted("%.1f somewhere on the maps in one of twenty data sets. The colours end at -%.0f "
                  "and %.0f.",
                  found_.base_maps.threshold, kColourEnd, kColourEnd) +
        (both ? " The base model comes first, then the model with " +
                    found_.found.hypothesis.name() + "."
              : ""));
    std::vector<report::Frame> frames;
    report::View view{{}, -kColourEnd, kColourEnd, strongest(found_.base_maps), true};
    const auto add = [&](const std::string& model, const assimilation::DisagreementMaps& maps) {
      for (const assimilation::DisagreementMap& map : maps.snapshots) {
        frames.push_back({0, map.z});
        view.labels.push_back(
            model +
            (setup_.series.size() > 1 ? ", vesicle " + setup_.series[map.vesicle].vesicle : "") +
            formatted(", t = %.4g s: up to %.1f", map.time * units_.seconds_per_unit(),
                      map.z.cwiseAbs().maxCoeff()) +
            " standard deviations");
      }
    };
    add("base model", found_.base_maps);
    if (both) add("with " + found_.found.hypothesis.name(), found_.found_maps);
    missing_.add(report::add_viewer(page_, {found_.map_mesh}, frames, view));
    if (found_.disagreements.empty()) {
      page_.paragraph(
          "No single patch of the surface (inside rafts, outside or at their boundaries) disagrees "
          "significantly with the base model. The verdict rests on all patches together.");
      return;
    }
    page_.paragraph(
        std::to_string(found_.disagreements.size()) +
        " patches of the surface disagree significantly with the base model. A patch "
        "is a twelfth of the surface in one snapshot, inside rafts, outside or at "
        "their boundaries. On average " +
        formatted("at most %.0f %% of such a list are there by chance", 100 * found_.false_alarms) +
        " (Benjamini and Hochberg). The strongest are:");
    page_.table(disagreement_rows(found_, setup_, kMostRows));
  }

  static std::size_t strongest(const assimilation::DisagreementMaps& maps) {
    const auto extreme = [](const assimilation::DisagreementMap& map) {
      return map.z.cwiseAbs().maxCoeff();
    };
    const auto most = std::max_element(
        maps.snapshots.begin(), maps.snapshots.end(),
        [&](const assimilation::DisagreementMap& a, const assimilation::DisagreementMap& b) {
          return extreme(a) < extreme(b);
        });
    return static_cast<std::size_t>(most - maps.snapshots.begin());
  }

  void add_what() {
    page_.heading("Candidates");
    for (const selection::Round& round : found_.rounds) {
      const std::string known = round.known.hypothesis.name();
      page_.paragraph((known.empty() ? std::string("What the base model lacks")
                                     : "What the model with " + known + " lacks") +
                      ". With noise alone, any candidate gains as much in at most " +
                      share(round.screening.p) +
                      " of data sets, and a gap of any shape is as large in at most " +
                      share(round.screening.gap_p) + ". Significant is a candidate below " +
                      share(found_.false_alarms) + ", and a gap below " +
                      share(selection::kGapLevel * found_.false_alarms) + ".");
      page_.table(score_rows(round));
    }
  }

  static std::string share(double p) { return p < 1e-3 ? "0.1 %" : formatted("%.1f %%", 100 * p); }

  const fs::path folder_;
  const selection::Explanation& found_;
  const ExplainSetup& setup_;
  const physics::Units units_;
  output::Page page_;
  output::Missing missing_;
};

}  // namespace

std::string write_explain_page(const fs::path& folder, const selection::Explanation& found,
                               const ExplainSetup& setup) {
  return ExplainPage(folder, found, setup).write();
}

}  // namespace traceraft::explain
