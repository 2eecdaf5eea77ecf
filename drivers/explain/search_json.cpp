#include "drivers/explain/search_json.hpp"

#include "drivers/input/json_members.hpp"
#include "kernel/core/error.hpp"

// The lists stand beside the reader and the writer, which find them there by argument.
namespace traceraft::input {

// Each list of members serves writing, reading and checking (json_members.hpp).

namespace {

// No search leads further than this from the D that it starts from.
constexpr double kLeastRatio = 1e-12, kMostRatio = 1e12;

struct StoredPart {
  std::string effect;
  std::vector<double> coefficients, values;  // values: of all parameters of the effect
};

template <class Members>
void describe(Members& members, StoredPart& part) {
  members("effect", part.effect);
  members("coefficients", part.coefficients);
  members("values", part.values);
}

using Parts = std::vector<assimilation::Hypothesis::Part>;

std::vector<StoredPart> stored_parts(const Parts& parts) {
  std::vector<StoredPart> stored;
  for (const auto& [candidate, coefficients] : parts)
    stored.push_back({candidate.name, coefficients, candidate.term(coefficients).values});
  return stored;
}

assimilation::Candidate candidate_of(const std::string& effect) {
  const std::optional<assimilation::Candidate> found = assimilation::find_candidate(effect);
  if (!found) throw DamagedFile("a search names '" + effect + "', which is not a candidate");
  return *found;
}

Parts parts_of(const std::vector<StoredPart>& stored) {
  Parts parts;
  for (const StoredPart& part : stored) {
    const effects::EffectTerm term{assimilation::effect_of(candidate_of(part.effect)), part.values};
    if (term.values.size() != effects::effects().find(term.effect).parameters.size())
      throw DamagedFile("a search has " + term.effect + " with unknown parameters");
    parts.push_back({assimilation::part_of(term, part.effect).candidate, part.coefficients});
    if (part.coefficients.size() != static_cast<std::size_t>(parts.back().candidate.directions))
      throw DamagedFile("a search has " + term.effect + " with unknown coefficients");
  }
  return parts;
}

std::vector<std::string> names_of(const std::vector<assimilation::Candidate>& candidates) {
  std::vector<std::string> names;
  for (const assimilation::Candidate& candidate : candidates) names.push_back(candidate.name);
  return names;
}

std::vector<assimilation::Candidate> candidates_of(const std::vector<std::string>& names) {
  std::vector<assimilation::Candidate> candidates;
  for (const std::string& name : names) candidates.push_back(candidate_of(name));
  return candidates;
}

const Words<selection::Finding>& finding_words() {
  static const Words<selection::Finding> words = [] {
    Words<selection::Finding> list;
    for (const selection::Finding finding : selection::kFindings)
      list.emplace_back(finding, selection::word_for(finding));
    return list;
  }();
  return words;
}

const Words<selection::SearchStep>& step_words() {
  static const Words<selection::SearchStep> words = [] {
    Words<selection::SearchStep> list;
    for (const auto& [step, word] : selection::kSearchSteps) list.emplace_back(step, word);
    return list;
  }();
  return words;
}

const Words<selection::ModelChange::Reason>& reasons() {
  static const Words<selection::ModelChange::Reason> words = {
      {selection::ModelChange::replaced, "replaced"},
      {selection::ModelChange::left_gap, "left-gap"},
      {selection::ModelChange::foretold, "foretold"},
      {selection::ModelChange::is_none, "is-none"}};
  return words;
}

}  // namespace

template <class Members>
void describe(Members& members, assimilation::Hypothesis& hypothesis) {
  members.stored("parts", hypothesis.parts, stored_parts, parts_of);
  members("known", hypothesis.known);
  if constexpr (Members::reads)
    members.require(hypothesis.known <= hypothesis.parts.size(),
                    "it knows more effects than it has");
}

template <class Members>
void describe(Members& members, assimilation::Gaps& gaps) {
  members("train", gaps.train);
  members("heldout", gaps.heldout);
}

template <class Members>
void describe(Members& members, assimilation::SnapshotGap& gap) {
  members("vesicle", gap.vesicle);
  members("snapshot", gap.snapshot);
  members("gap", gap.gap);
  members("expected", gap.expected);
}

template <class Members>
void describe(Members& members, selection::Refit& fit) {
  members("hypothesis", fit.hypothesis);
  members("diffusion_ratio", fit.diffusion_ratio, WithinRange{kLeastRatio, kMostRatio});
  members("deviance", fit.deviance);
  members("covariance", fit.covariance);
  members("diffusion_ratio_deviation", fit.diffusion_ratio_deviation);
  members("gap", fit.gap);
  members("expected", fit.expected);
  members("random", fit.random);
  members("random_gain", fit.random_gain);
  members("snapshots", fit.snapshots);
  members("settled", fit.settled);
  members("failure", fit.failure);
  if constexpr (Members::reads)
    members.require(fit.covariance.rows() == fit.covariance.cols(), "a covariance is not square");
}

template <class Members>
void describe(Members& members, selection::CandidateScore& score) {
  members("effect", score.effect);
  members("coefficients", score.coefficients);
  members("score", score.score);
  members("null_mean", score.null_mean);
  members("p", score.p);
  members("response", score.response);
  members("covariance", score.covariance);
  members("resolution", score.resolution);
}

template <class Members>
void describe(Members& members, selection::ConfoundedWithDiffusionRatio& confounded) {
  members("effect", confounded.effect);
  members("slope", confounded.slope);
  members("correlation", confounded.correlation);
}

template <class Members>
void describe(Members& members, selection::Screening& screening) {
  members("scores", screening.scores);
  members("p", screening.p);
  members("train_gap_p", screening.train_gap_p);
  members("heldout_gap_p", screening.heldout_gap_p);
  members("gap_p", screening.gap_p);
  members("diffusion_ratio_change", screening.diffusion_ratio_change);
  members("diffusion_ratio_deviation", screening.diffusion_ratio_deviation);
  members("mesh_error", screening.mesh_error);
  members("confounded_with_diffusion_ratio", screening.confounded);
}

template <class Members>
void describe(Members& members, selection::Round::Failure& failure) {
  members("effect", failure.effect);
  members("why", failure.why);
}

// Without the base model, which all rounds share.
template <class Members>
void describe(Members& members, selection::Round& round) {
  members("known", round.known.hypothesis);
  members("diffusion_ratio", round.known.diffusion_ratio, WithinRange{kLeastRatio, kMostRatio});
  members.stored("screened", round.known.screened, names_of, candidates_of);
  members("screening", round.screening);
  members("without", round.without);
  members("refits", round.refits);
  members("failures", round.failures);
  members("moves", round.moves);
}

template <class Members>
void describe(Members& members, assimilation::Disagreement& disagreement) {
  members("vesicle", disagreement.vesicle);
  members("time", disagreement.time);
  members("state", disagreement.state);
  members("direction", disagreement.direction);
  members("z", disagreement.z);
  members("p", disagreement.p);
}

template <class Members>
void describe(Members& members, selection::FrameChange& change) {
  members("vesicle", change.vesicle);
  members("snapshot", change.snapshot);
  members("rotation", change.rotation);
  members("gain", change.gain);
  members("offset", change.offset);
}

template <class Members>
void describe(Members& members, assimilation::DisagreementMap& map) {
  members("vesicle", map.vesicle);
  members("time", map.time);
  members("z", map.z);
}

template <class Members>
void describe(Members& members, assimilation::DisagreementMaps& maps) {
  members("snapshots", maps.snapshots);
  members("threshold", maps.threshold);
}

template <class Members>
void describe(Members& members, selection::Rerun& rerun) {
  members("cells", rerun.cells);
  members("integrator", rerun.integrator);
  members("base", rerun.base);
  members("found", rerun.found);
  members("floor", rerun.floor);
  members("failure", rerun.failure);
  members("gain", rerun.gain);
  members("shortfall", rerun.shortfall);
  members("doubt", rerun.doubt);
  members("gap_p", rerun.gap_p);
  members("gap_failure", rerun.gap_failure);
}

template <class Members>
void describe(Members& members, assimilation::NoiseCorrelation::Component& component) {
  members("support", component.support);
  members("share", component.share);
}

template <class Members>
void describe(Members& members, assimilation::NoiseCorrelation& correlation) {
  members("components", correlation.components);
  members("at_bound", correlation.at_bound);
  members("error", correlation.error);
}

template <class Members>
void describe(Members& members, assimilation::NoiseModel& noise) {
  members("levels", noise.levels);
  members("first", noise.first);
  members("correlation", noise.correlation);
}

template <class Members>
void describe(Members& members, selection::ForecastPoint& point) {
  members("noise", point.noise);
  members("diffusion_ratio", point.diffusion_ratio, WithinRange{kLeastRatio, kMostRatio});
  members("hypothesis", point.hypothesis);
}

template <class Members>
void describe(Members& members, selection::RegisteredRotation& rotation) {
  members("vesicle", rotation.vesicle);
  members("snapshot", rotation.snapshot);
  members("angle", rotation.angle);
}

template <class Members>
void describe(Members& members, selection::Excluded& excluded) {
  members("effect", excluded.effect);
  members("less", excluded.less);
}

template <class Members>
void describe(Members& members, selection::ModelChange& change) {
  members.word("reason", change.reason, reasons());
  members("from", change.from);
  members("to", change.to);
}

// Without the mesh of its maps, which the data have.
template <class Members>
void describe(Members& members, selection::Explanation& found) {
  members.word("finding", found.finding, finding_words());
  members.word("without_gap", found.without_gap, finding_words());
  members("false_alarms", found.false_alarms);
  members("diffusion_ratio_doubt", found.diffusion_ratio_doubt);
  members("h_over_epsilon", found.h_over_epsilon);
  members("outliers", found.outliers);
  members("at_rest", found.at_rest);
  members("registered", found.registered);
  members("noise", found.noise);
  members("noise_model", found.noise_model);
  members("base", found.base);
  members("found", found.found);
  members("rivals", found.rivals);
  members("excluded", found.excluded);
  members("changes", found.changes);
  members("rounds", found.rounds);
  members("stopped", found.stopped);
  members("frames", found.frames);
  members("disagreements", found.disagreements);
  members("base_maps", found.base_maps);
  members("found_maps", found.found_maps);
  members("rerun", found.rerun);
}

template <class Members>
void describe(Members& members, selection::SearchState& state) {
  members.word("next", state.next, step_words());
  members("maps_at", state.maps_at);
  members("fields_at", state.fields_at);
  members("weighed", state.weighed);
  members("eliminated", state.eliminated);
  members("replacements", state.replacements);
  members("refits", state.refits);
  members("so_far", state.so_far);
}

}  // namespace traceraft::input

namespace traceraft::explain {

input::Json search_json(const selection::SearchState& state) {
  return input::object_of(state);
}

selection::SearchState search_from(const input::Json& json,
                                   const problem::CahnHilliardModel& base) {
  selection::SearchState state;
  input::JsonReader reader(json, "the search");
  describe(reader, state);
  for (selection::Round& round : state.so_far.rounds) round.known.base = base;
  return state;
}

}  // namespace traceraft::explain
