#include "drivers/explain/explain_report.hpp"

#include "drivers/config/config_file.hpp"
#include "drivers/explain/explain_tables.hpp"
#include "drivers/explain/extended_model.hpp"
#include "drivers/explain/remarks.hpp"
#include "drivers/explain/verdict.hpp"
#include "drivers/explain/verdict_sentence.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/text.hpp"
#include "verification/bench/figures.hpp"

namespace traceraft::explain {
namespace {

bench::Table scores_table(const selection::Explanation& found) {
  bench::Table table{"scores", {"round", "effect", "score", "of noise", "p", "response/noise"}, {}};
  for (std::size_t k = 0; k < found.rounds.size(); ++k)
    for (const selection::CandidateScore& s : found.rounds[k].screening.scores)
      table.rows.push_back(
          {static_cast<double>(k + 1), s.effect, s.score, s.null_mean, s.p, s.response});
  return table;
}

bench::Table disagreements_table(const selection::Explanation& found, const ExplainSetup& setup,
                                 const physics::Units& units) {
  bench::Table table{
      "disagreements", {"vesicle", "time/s", "state", "x", "y", "z", "deviations", "p"}, {}};
  for (const assimilation::Disagreement& d : found.disagreements)
    table.rows.push_back({setup.series[d.vesicle].vesicle, d.time * units.seconds_per_unit(),
                          d.state, d.direction[0], d.direction[1], d.direction[2], d.z, d.p});
  return table;
}

// The second run may yet refute it.
bool has_model(const selection::Explanation& found) {
  return selection::is_named(found) && found.rerun;
}

}  // namespace

void write_explanation(const std::filesystem::path& folder, const selection::Explanation& found,
                       const ExplainSetup& setup) {
  const physics::Units units = setup.configuration.units();
  posix::write_durably(folder / "scores.csv", output::csv_text(scores_table(found)));
  posix::write_durably(folder / "disagreements.csv",
                       output::csv_text(disagreements_table(found, setup, units)));
  if (has_model(found))
    write_extended_model(
        folder / "model.toml", setup.model_file, found_model(found, setup.model),
        "found by traceraft explain: " + found.found.hypothesis.name() +
            (setup.request.own.parts.empty()
                 ? ", with D refitted together with it"
                 : ", with D and the model's own effects refitted together with it"));
  input::write_json(folder / "verdict.json", verdict_json(verdict_of(found, setup)));
}

std::string command_for_found(const std::filesystem::path& folder,
                              const selection::Explanation& found, const ExplainSetup& setup) {
  if (!has_model(found)) return "";
  return "traceraft run --config " + text::in_shell((folder / "model.toml").string()) +
         " --t-end " + formatted("%.6g", setup.last_s());
}

void print_explanation(const selection::Explanation& found, const ExplainSetup& setup) {
  const physics::Units units = setup.configuration.units();
  text::say("\n%s\n\nVerdict: %s\n%s\n\n", data_text(setup),
            verdict_words(found.finding, selection::class_of(found)), verdict_sentence(found));
  if (!found.at_rest) {
    output::print_rows(parameter_rows(found, units));
    text::say("\n");
    output::print_rows(gap_rows(found));
  }
  for (const std::string& remark : remarks_on(found, setup)) text::say("\n%s\n", remark);
  text::say("\nnoise of the measurements: %.3g, %s\n", found.noise,
            assimilation::text_of(found.noise_model.correlation));
  if (!found.at_rest)
    text::say("patches that disagree significantly with the base model: %zu\n",
              found.disagreements.size());
}

}  // namespace traceraft::explain
