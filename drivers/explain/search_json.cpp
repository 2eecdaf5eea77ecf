#include "drivers/explain/search_json.hpp"

#include "drivers/input/json_members.hpp"
#include "kernel/core/error.hpp"

namespace traceraft {

// Each list of members serves writing, reading and checking (json_members.hpp).

namespace {

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

using Parts = std::vector<Hypothesis::Part>;

std::vector<StoredPart> stored_parts(const Parts& parts) {
  std::vector<StoredPart> stored;
  for (const auto& [candidate, coefficients] : parts)
    stored.push_back({candidate.effect, coefficients, candidate.term(coefficients).values});
  return stored;
}

Candidate candidate_of(const std::string& effect) {
  const std::optional<Candidate> found = find_candidate(effect);
  if (!found) throw DamagedFile("a search names '" + effect + "', which is not a candidate");
  return *found;
}

Parts parts_of(const std::vector<StoredPart>& stored) {
  Parts parts;
  for (const StoredPart& part : stored) {
    const EffectTerm term{candidate_of(part.effect).effect, part.values};
    if (term.values.size() != effects().find(term.effect).parameters.size())
      throw DamagedFile("a search has " + term.effect + " with unknown parameters");
    parts.push_back({part_of(term).candidate, part.coefficients});
    if (part.coefficients.size() != static_cast<std::size_t>(parts.back().candidate.directions))
      throw DamagedFile("a search has " + term.effect + " with unknown coefficients");
  }
  return parts;
}

std::vector<std::string> names_of(const std::vector<Candidate>& candidates) {
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates) names.push_back(candidate.effect);
  return names;
}

std::vector<Candidate> candidates_of(const std::vector<std::string>& names) {
  std::vector<Candidate> candidates;
  for (const std::string& name : names) candidates.push_back(candidate_of(name));
  return candidates;
}

const Words<Finding>& finding_words() {
  static const Words<Finding> words = [] {
    Words<Finding> list;
    for (const Finding finding : kFindings) list.emplace_back(finding, word_for(finding));
    return list;
  }();
  return words;
}

const Words<SearchStep>& step_words() {
  static const Words<SearchStep> words = [] {
    Words<SearchStep> list;
    for (const auto& [step, word] : kSearchSteps) list.emplace_back(step, word);
    return list;
  }();
  return words;
}

const Words<ModelChange::Reason>& reasons() {
  static const Words<ModelChange::Reason> words = {{ModelChange::replaced, "replaced"},
                                                   {ModelChange::left_gap, "left-gap"},
                                                   {ModelChange::foretold, "foretold"},
                                                   {ModelChange::is_none, "is-none"}};
  return words;
}

}  // namespace

template <class Members>
void describe(Members& members, Hypothesis& hypothesis) {
  members.stored("parts", hypothesis.parts, stored_parts, parts_of);
  members("known", hypothesis.known);
  if constexpr (Members::reads)
    members.require(hypothesis.known <= hypothesis.parts.size(),
                    "it knows more effects than it has");
}

template <class Members>
void describe(Members& members, Gaps& gaps) {
  members("train", gaps.train);
  members("heldout", gaps.heldout);
}

template <class Members>
void describe(Members& members, SnapshotGap& gap) {
  members("vesicle", gap.vesicle);
  members("snapshot", gap.snapshot);
  members("gap", gap.gap);
  members("expected", gap.expected);
}

template <class Members>
void describe(Members& members, Refit& fit) {
  members("hypothesis", fit.hypothesis);
  members("pace", fit.pace);
  members("deviance", fit.deviance);
  members("covariance", fit.covariance);
  members("pace_deviation", fit.pace_deviation);
  members("gap", fit.gap);
  members("expected", fit.expected);
  members("snapshots", fit.snapshots);
  members("settled", fit.settled);
  members("failure", fit.failure);
  if constexpr (Members::reads)
    members.require(fit.covariance.rows() == fit.covariance.cols(), "a covariance is not square");
}

template <class Members>
void describe(Members& members, CandidateScore& score) {
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
void describe(Members& members, ConfoundedWithPace& confounded) {
  members("effect", confounded.effect);
  members("slope", confounded.slope);
  members("correlation", confounded.correlation);
}

template <class Members>
void describe(Members& members, Screening& screening) {
  members("scores", screening.scores);
  members("p", screening.p);
  members("train_gap_p", screening.train_gap_p);
  members("heldout_gap_p", screening.heldout_gap_p);
  members("gap_p", screening.gap_p);
  members("pace_change", screening.pace_change);
  members("pace_deviation", screening.pace_deviation);
  members("mesh_error", screening.mesh_error);
  members("confounded_with_pace", screening.confounded);
}

template <class Members>
void describe(Members& members, Round::Failure& failure) {
  members("effect", failure.effect);
  members("why", failure.why);
}

// Without the base model, which all rounds share.
template <class Members>
void describe(Members& members, Round& round) {
  members("known", round.known.hypothesis);
  members("pace", round.known.pace);
  members.stored("screened", round.known.screened, names_of, candidates_of);
  members("screening", round.screening);
  members("without", round.without);
  members("refits", round.refits);
  members("failures", round.failures);
  members("moves", round.moves);
}

template <class Members>
void describe(Members& members, Disagreement& disagreement) {
  members("vesicle", disagreement.vesicle);
  members("time", disagreement.time);
  members("state", disagreement.state);
  members("direction", disagreement.direction);
  members("z", disagreement.z);
  members("p", disagreement.p);
}

template <class Members>
void describe(Members& members, FrameChange& change) {
  members("vesicle", change.vesicle);
  members("snapshot", change.snapshot);
  members("rotation", change.rotation);
  members("gain", change.gain);
  members("offset", change.offset);
}

template <class Members>
void describe(Members& members, DisagreementMap& map) {
  members("vesicle", map.vesicle);
  members("time", map.time);
  members("z", map.z);
}

template <class Members>
void describe(Members& members, DisagreementMaps& maps) {
  members("snapshots", maps.snapshots);
  members("threshold", maps.threshold);
}

template <class Members>
void describe(Members& members, Rerun& rerun) {
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
void describe(Members& members, NoiseCorrelation::Component& component) {
  members("support", component.support);
  members("share", component.share);
}

template <class Members>
void describe(Members& members, NoiseCorrelation& correlation) {
  members("components", correlation.components);
  members("at_bound", correlation.at_bound);
  members("error", correlation.error);
}

template <class Members>
void describe(Members& members, NoiseModel& noise) {
  members("levels", noise.levels);
  members("first", noise.first);
  members("correlation", noise.correlation);
}

template <class Members>
void describe(Members& members, ForecastPoint& point) {
  members("noise", point.noise);
  members("pace", point.pace);
  members("hypothesis", point.hypothesis);
}

template <class Members>
void describe(Members& members, RegisteredRotation& rotation) {
  members("vesicle", rotation.vesicle);
  members("snapshot", rotation.snapshot);
  members("angle", rotation.angle);
}

template <class Members>
void describe(Members& members, Excluded& excluded) {
  members("effect", excluded.effect);
  members("less", excluded.less);
}

template <class Members>
void describe(Members& members, ModelChange& change) {
  members.word("reason", change.reason, reasons());
  members("from", change.from);
  members("to", change.to);
}

// Without the mesh of its maps, which the data have.
template <class Members>
void describe(Members& members, Explanation& found) {
  members.word("finding", found.finding, finding_words());
  members.word("without_gap", found.without_gap, finding_words());
  members("false_alarms", found.false_alarms);
  members("pace_doubt", found.pace_doubt);
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
void describe(Members& members, SearchState& state) {
  members.word("next", state.next, step_words());
  members("maps_at", state.maps_at);
  members("fields_at", state.fields_at);
  members("weighed", state.weighed);
  members("eliminated", state.eliminated);
  members("replacements", state.replacements);
  members("refits", state.refits);
  members("so_far", state.so_far);
}

Json search_json(const SearchState& state) {
  return object_of(state);
}

SearchState search_from(const Json& json, const CahnHilliardModel& base) {
  SearchState state;
  JsonReader reader(json, "the search");
  describe(reader, state);
  for (Round& round : state.so_far.rounds) round.known.base = base;
  return state;
}

}  // namespace traceraft
