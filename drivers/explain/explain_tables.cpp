#include "drivers/explain/explain_tables.hpp"

#include <cmath>

#include "kernel/core/text.hpp"
#include "verification/statistics/sample.hpp"

namespace traceraft::explain {
namespace {

// D is known by its logarithm: far from certain, it is so within a factor.
std::string interval_of(const FoundParameter& p) {
  constexpr double kLinear = 0.3, kHopeless = 1000;
  if (!p.sigma) return p.effect.empty() ? "not known" : "assumed";
  const double relative = statistics::kNormal95 * *p.sigma / std::fabs(p.value);
  if (!p.effect.empty() || relative < kLinear)
    return formatted("%.2g", statistics::kNormal95 * *p.sigma);
  const double factor = std::exp(relative);
  return factor < kHopeless ? formatted("a factor of %.2g", factor) : "not determined";
}

}  // namespace

std::vector<output::Row> parameter_rows(const selection::Explanation& found,
                                        const physics::Units& base) {
  std::vector<output::Row> rows{{"parameter", "value", "95 % +-", "unit"}};
  const auto add = [&](const selection::Refit& fit, const std::string& before) {
    for (const FoundParameter& p : told_parameters(found, fit, base))
      rows.push_back({before + p.effect + (p.effect.empty() ? "" : " ") + p.name,
                      formatted("%.4g", p.value), interval_of(p), p.unit});
  };
  add(fit_shown(found), "");
  if (found.finding == selection::Finding::ambiguous)
    for (const selection::Refit& fit : found.rivals) add(fit, "or: ");
  return rows;
}

std::vector<output::Row> bound_rows(const selection::Explanation& found,
                                    const physics::Units& base) {
  std::vector<output::Row> rows{{"effect", "parameter", "at least", "at most", "unit"}};
  for (const FoundBound& b : found_bounds(found, base))
    if (b.seen)
      rows.push_back(
          {b.effect, b.name, formatted("%.3g", b.low), formatted("%.3g", b.high), b.unit});
    else
      rows.push_back({b.effect, b.name, "", "not visible in these data", b.unit});
  return rows;
}

std::vector<output::Row> gap_rows(const selection::Explanation& found) {
  std::vector<output::Row> rows{{"measured minus forecast, in c", "fitted", "held out"}};
  const auto add = [&](const std::string& name, const assimilation::Gaps& g) {
    rows.push_back(
        {name, formatted("%.4g", g.train), g.heldout > 0 ? formatted("%.4g", g.heldout) : ""});
  };
  const bool more = found.found.hypothesis.added() > 0;
  const std::string name = selection::is_named(found) ? "what was found" : "what comes closest";
  add("base model", found.base.gap);
  if (more) add(name, found.found.gap);
  if (const auto second = selection::runner_up(found)) add("second best", *second);
  add("to be expected if nothing is missing", found.found.expected);
  if (more) {
    const auto text = [](const std::optional<double>& share) {
      return share ? formatted("%.0f %%", 100 * *share) : "too small to say";
    };
    const assimilation::SharesClosed closed = selection::shares_closed(found.base, found.found);
    rows.push_back({"share of the closable gap that is closed (of squares)", text(closed.train),
                    text(closed.heldout)});
  }
  if (found.rerun && found.rerun->failure.empty()) {
    const selection::Rerun& rerun = *found.rerun;
    const std::string where =
        " (" + std::to_string(rerun.cells) + " cells, " + rerun.integrator + ")";
    add("base model" + where, rerun.base);
    if (more) add(name + where, rerun.found);
    add("to be expected" + where, rerun.floor);
  }
  return rows;
}

std::vector<output::Row> score_rows(const selection::Round& round) {
  std::vector<output::Row> rows{
      {"effect", "2 ln likelihood ratio", "of noise alone", "p", "refitted"}};
  for (const selection::CandidateScore& s : round.screening.scores) {
    std::string refitted;
    for (const selection::Refit& fit : round.refits)
      if (fit.hypothesis.parts.back().candidate.name == s.effect)
        refitted = formatted("%.1f", round.without.deviance - fit.deviance);
    rows.push_back({s.effect, formatted("%.1f", s.score), formatted("%.1f", s.null_mean),
                    formatted("%.3f", s.p), refitted});
  }
  return rows;
}

std::vector<output::Row> disagreement_rows(const selection::Explanation& found,
                                           const ExplainSetup& setup, std::size_t most) {
  const physics::Units base = setup.configuration.units();
  std::vector<output::Row> rows{
      {"vesicle", "time (s)", "where", "around (x, y, z), in R", "standard deviations", "p"}};
  for (const assimilation::Disagreement& d : found.disagreements) {
    if (rows.size() > most) break;
    rows.push_back({setup.series[d.vesicle].vesicle,
                    formatted("%.4g", d.time * base.seconds_per_unit()), d.state,
                    formatted("%.2f, %.2f, %.2f", d.direction[0], d.direction[1], d.direction[2]),
                    formatted("%+.1f", d.z), formatted("%.1e", d.p)});
  }
  return rows;
}

}  // namespace traceraft::explain
