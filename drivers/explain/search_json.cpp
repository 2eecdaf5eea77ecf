#include "drivers/explain/search_json.hpp"

#include <cmath>
#include <limits>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

// JSON has no infinity.
Json json_of(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}
double number_of(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

Json json_of(const Vec& values) {
  return std::vector<double>(values.begin(), values.end());
}
Vec vec_of(const Json& json) {
  const std::vector<double> values = json;
  return Eigen::Map<const Vec>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Symmetric ones.
Json json_of(const Eigen::MatrixXd& square) {
  return json_of(Vec(square.reshaped()));
}
Eigen::MatrixXd square_of(const Json& json) {
  const Vec values = vec_of(json);
  const auto n = static_cast<Eigen::Index>(std::lround(std::sqrt(double(values.size()))));
  if (n * n != values.size()) throw DamagedFile("a matrix of a search is not square");
  return values.reshaped(n, n);
}

Candidate candidate_of(const std::string& effect) {
  const std::optional<Candidate> found = find_candidate(effect);
  if (!found) throw DamagedFile("a search names '" + effect + "', which is no candidate");
  return *found;
}

Json json_of(const Hypothesis& hypothesis) {
  Json parts = Json::array();
  for (const auto& part : hypothesis.parts)
    parts.push_back({{"effect", part.candidate.effect},
                     {"coefficients", part.coefficients},
                     {"values", part.candidate.term(part.coefficients).values}});
  return {{"parts", parts}, {"known", hypothesis.known}};
}
Hypothesis hypothesis_of(const Json& json) {
  Hypothesis hypothesis;
  hypothesis.known = json.at("known");
  for (const Json& part : json.at("parts")) {
    const EffectTerm term{candidate_of(part.at("effect")).effect, part.at("values")};
    if (term.values.size() != effects().find(term.effect).parameters.size())
      throw DamagedFile("a search has " + term.effect + " with parameters that it has not");
    hypothesis.parts.push_back({part_of(term).candidate, part.at("coefficients")});
    const Hypothesis::Part& read = hypothesis.parts.back();
    if (read.coefficients.size() != static_cast<std::size_t>(read.candidate.directions))
      throw DamagedFile("a search has " + term.effect + " with coefficients that it has not");
  }
  if (hypothesis.known > hypothesis.parts.size())
    throw DamagedFile("a search knows more effects than it has");
  return hypothesis;
}

Json json_of(const Gaps& gaps) {
  return {gaps.train, gaps.heldout};
}
Gaps gaps_of(const Json& json) {
  return {json.at(0), json.at(1)};
}

Json json_of(const Refit& fit) {
  Json snapshots = Json::array();
  for (const SnapshotGap& s : fit.snapshots)
    snapshots.push_back({s.vesicle, s.snapshot, s.gap, s.expected});
  return {{"hypothesis", json_of(fit.hypothesis)},
          {"pace", fit.pace},
          {"deviance", json_of(fit.deviance)},
          {"covariance", json_of(fit.covariance)},
          {"pace_deviation", fit.pace_deviation},
          {"gap", json_of(fit.gap)},
          {"expected", json_of(fit.expected)},
          {"snapshots", snapshots},
          {"settled", fit.settled},
          {"failure", fit.failure}};
}
Refit refit_of(const Json& json) {
  Refit fit{hypothesis_of(json.at("hypothesis")),
            json.at("pace"),
            number_of(json.at("deviance")),
            square_of(json.at("covariance")),
            json.at("pace_deviation"),
            gaps_of(json.at("gap")),
            gaps_of(json.at("expected")),
            {},
            json.at("settled"),
            json.at("failure")};
  for (const Json& s : json.at("snapshots"))
    fit.snapshots.push_back({s.at(0), s.at(1), s.at(2), s.at(3)});
  return fit;
}

Json json_of(const Screening& screening) {
  Json scores = Json::array();
  for (const CandidateScore& s : screening.scores)
    scores.push_back({{"effect", s.effect},
                      {"coefficients", s.coefficients},
                      {"score", s.score},
                      {"null_mean", s.null_mean},
                      {"p", s.p},
                      {"response", s.response},
                      {"covariance", json_of(s.covariance)},
                      {"resolution", json_of(s.resolution)}});
  Json confounded = Json::array();
  for (const ConfoundedWithPace& c : screening.confounded)
    confounded.push_back({c.effect, c.slope, c.correlation});
  return {{"scores", scores},
          {"confounded_with_pace", confounded},
          {"p", screening.p},
          {"gap_p", {screening.train_gap_p, screening.heldout_gap_p, screening.gap_p}},
          {"pace_change", screening.pace_change},
          {"pace_deviation", screening.pace_deviation},
          {"mesh_error", screening.mesh_error}};
}
Screening screening_of(const Json& json) {
  const Json& gap_p = json.at("gap_p");
  Screening screening{{},
                      json.at("p"),
                      gap_p.at(0),
                      gap_p.at(1),
                      gap_p.at(2),
                      json.at("pace_change"),
                      json.at("pace_deviation"),
                      json.at("mesh_error"),
                      {}};
  for (const Json& c : json.at("confounded_with_pace"))
    screening.confounded.push_back({c.at(0), c.at(1), c.at(2)});
  for (const Json& s : json.at("scores"))
    screening.scores.push_back({s.at("effect"), s.at("coefficients"), s.at("score"),
                                s.at("null_mean"), s.at("p"), s.at("response"),
                                square_of(s.at("covariance")), number_of(s.at("resolution"))});
  return screening;
}

Json json_of(const Round& round) {
  Json screened = Json::array(), refits = Json::array(), failures = Json::array(),
       moves = Json::array();
  for (const Candidate& candidate : round.known.screened) screened.push_back(candidate.effect);
  for (const Refit& fit : round.refits) refits.push_back(json_of(fit));
  for (const Round::Failure& failure : round.failures)
    failures.push_back({failure.effect, failure.why});
  for (const Refit& fit : round.moves) moves.push_back(json_of(fit));
  return {{"known", json_of(round.known.hypothesis)},
          {"pace", round.known.pace},
          {"screened", screened},
          {"screening", json_of(round.screening)},
          {"without", json_of(round.without)},
          {"refits", refits},
          {"failures", failures},
          {"moves", moves}};
}
Round round_of(const Json& json, const CahnHilliardModel& base) {
  Round round{{base, json.at("pace"), hypothesis_of(json.at("known")), {}},
              screening_of(json.at("screening")),
              refit_of(json.at("without")),
              {},
              {},
              {}};
  for (const std::string effect : json.at("screened"))
    round.known.screened.push_back(candidate_of(effect));
  for (const Json& fit : json.at("refits")) round.refits.push_back(refit_of(fit));
  for (const Json& failure : json.at("failures"))
    round.failures.push_back({failure.at(0), failure.at(1)});
  for (const Json& fit : json.at("moves")) round.moves.push_back(refit_of(fit));
  return round;
}

Json json_of(const Disagreement& d) {
  return {{"vesicle", d.vesicle},
          {"time", d.time},
          {"state", d.state},
          {"direction", json_of(Vec(d.direction))},
          {"z", d.z},
          {"p", d.p}};
}
Disagreement disagreement_of(const Json& json) {
  const Vec direction = vec_of(json.at("direction"));
  if (direction.size() != 3) throw DamagedFile("a direction of a search is none");
  return {json.at("vesicle"), json.at("time"), json.at("state"),
          Point(direction),   json.at("z"),    json.at("p")};
}

Json json_of(const FrameChange& change) {
  return {change.vesicle, change.snapshot, change.turn, change.gain, change.offset};
}
FrameChange change_of(const Json& json) {
  return {json.at(0), json.at(1), json.at(2), json.at(3), json.at(4)};
}

Json json_of(const DisagreementMaps& maps) {
  Json snapshots = Json::array();
  for (const DisagreementMap& map : maps.snapshots)
    snapshots.push_back({{"vesicle", map.vesicle}, {"time", map.time}, {"z", json_of(map.z)}});
  return {{"snapshots", snapshots}, {"threshold", maps.threshold}};
}
DisagreementMaps maps_of(const Json& json) {
  DisagreementMaps maps{{}, json.at("threshold")};
  for (const Json& map : json.at("snapshots"))
    maps.snapshots.push_back({map.at("vesicle"), map.at("time"), vec_of(map.at("z"))});
  return maps;
}

Json json_of(const std::optional<Rerun>& rerun) {
  if (!rerun) return {};
  return {{"cells", rerun->cells},
          {"integrator", rerun->integrator},
          {"base", json_of(rerun->base)},
          {"found", json_of(rerun->found)},
          {"floor", json_of(rerun->floor)},
          {"failure", rerun->failure},
          {"gain", rerun->gain},
          {"shortfall", rerun->shortfall},
          {"doubt", rerun->doubt},
          {"gap_p", rerun->gap_p ? Json(*rerun->gap_p) : Json()},
          {"gap_failure", rerun->gap_failure}};
}
std::optional<Rerun> rerun_of(const Json& json) {
  if (json.is_null()) return {};
  Rerun rerun{json.at("cells"),          json.at("integrator"),     gaps_of(json.at("base")),
              gaps_of(json.at("found")), gaps_of(json.at("floor")), json.at("failure"),
              json.at("gain"),           json.at("shortfall"),      json.at("doubt")};
  if (const Json& p = json.at("gap_p"); !p.is_null()) rerun.gap_p = p.get<double>();
  rerun.gap_failure = json.at("gap_failure");
  return rerun;
}

Json json_of(const NoiseCorrelation& correlation) {
  Json components = Json::array();
  for (const NoiseCorrelation::Component& c : correlation.components)
    components.push_back({c.support, c.share});
  return {
      {"components", components}, {"at_bound", correlation.at_bound}, {"error", correlation.error}};
}
NoiseCorrelation correlation_of(const Json& json) {
  NoiseCorrelation correlation;
  for (const Json& c : json.at("components")) correlation.components.push_back({c.at(0), c.at(1)});
  correlation.at_bound = json.at("at_bound");
  correlation.error = json.at("error");
  return correlation;
}

Finding finding_of(const std::string& word) {
  for (const Finding finding : kFindings)
    if (word_for(finding) == word) return finding;
  throw DamagedFile("a search cannot end with '" + word + "'");
}

Turn::Why why_of(const Json& json) {
  const auto number = json.get<int>();
  if (number < Turn::replaced || number > Turn::is_none)
    throw DamagedFile("a search has changed its mind for no reason that there is");
  return static_cast<Turn::Why>(number);
}

}  // namespace

Json search_json(const SearchState& state) {
  const Explanation& found = state.so_far;
  Json rounds = Json::array(), rivals = Json::array(), told_apart = Json::array(),
       turns = Json::array(), disagreements = Json::array(), changes = Json::array(),
       ahead = Json::array();
  for (const Round& round : found.rounds) rounds.push_back(json_of(round));
  for (const Refit& fit : found.rivals) rivals.push_back(json_of(fit));
  for (const ToldApart& t : found.told_apart) told_apart.push_back({t.effect, t.less});
  for (const Turn& turn : found.turns) turns.push_back({turn.why, turn.from, turn.to});
  for (const Disagreement& d : found.disagreements) disagreements.push_back(json_of(d));
  for (const FrameChange& change : found.changes) changes.push_back(json_of(change));
  for (const auto& [number, fit] : state.ahead) ahead.push_back({number, json_of(fit)});
  return {{"more", state.more},
          {"class_weighed", state.told_apart},
          {"noise", state.noise},
          {"noise_correlation", json_of(state.correlation)},
          {"finding", word_for(found.finding)},
          {"without_gap", word_for(found.without_gap)},
          {"rivals", rivals},
          {"base", json_of(found.base)},
          {"found", json_of(found.found)},
          {"rounds", rounds},
          {"disagreements", disagreements},
          {"changes", changes},
          {"told_apart", told_apart},
          {"turns", turns},
          {"ahead", ahead},
          {"stopped", found.stopped},
          {"rerun", json_of(found.rerun)},
          {"base_maps", json_of(found.base_maps)},
          {"found_maps", json_of(found.found_maps)}};
}

SearchState search_from(const Json& json, const CahnHilliardModel& base) {
  SearchState state;
  state.more = json.at("more");
  state.told_apart = json.at("class_weighed");
  state.noise = json.at("noise").get<std::vector<std::vector<double>>>();
  state.correlation = correlation_of(json.at("noise_correlation"));
  Explanation& found = state.so_far;
  found.finding = finding_of(json.at("finding"));
  found.without_gap = finding_of(json.at("without_gap"));
  for (const Json& fit : json.at("rivals")) found.rivals.push_back(refit_of(fit));
  found.base = refit_of(json.at("base"));
  found.found = refit_of(json.at("found"));
  for (const Json& round : json.at("rounds")) found.rounds.push_back(round_of(round, base));
  for (const Json& d : json.at("disagreements")) found.disagreements.push_back(disagreement_of(d));
  for (const Json& change : json.at("changes")) found.changes.push_back(change_of(change));
  for (const Json& t : json.at("told_apart")) found.told_apart.push_back({t.at(0), t.at(1)});
  for (const Json& turn : json.at("turns"))
    found.turns.push_back({why_of(turn.at(0)), turn.at(1), turn.at(2)});
  for (const Json& fit : json.at("ahead")) state.ahead[fit.at(0)] = refit_of(fit.at(1));
  found.stopped = json.at("stopped");
  found.rerun = rerun_of(json.at("rerun"));
  found.base_maps = maps_of(json.at("base_maps"));
  found.found_maps = maps_of(json.at("found_maps"));
  return state;
}

}  // namespace traceraft
