#include "verification/assimilation/forecast/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "kernel/geometry/star_surface.hpp"
#include "verification/assimilation/forecast/curvature_contrast.hpp"
#include "verification/bench/bench.hpp"

namespace traceraft::assimilation {
namespace {

// The value of parameters that are lengths and are not looked for, in R.
constexpr double kLength = 1;
// Contrast of the curvature, below which it sorts nothing.
constexpr double kCurved = 0.05;

// The strength is the only coefficient; the other parameters keep their values.
std::function<effects::EffectTerm(const std::vector<double>&)> strength_of(effects::EffectTerm term,
                                                                           std::size_t parameter) {
  return [term = std::move(term), parameter](const std::vector<double>& a) {
    effects::EffectTerm result = term;
    result.values[parameter] = a[0];
    return result;
  };
}

effects::EffectTerm by_default(const effects::EffectEntry& entry) {
  effects::EffectTerm term{entry.name, {}};
  for (const ParameterSpec& spec : entry.parameters)
    term.values.push_back(spec.unit == "um" ? kLength : spec.default_value);
  return term;
}

Candidate by_strength(const std::string& effect, double step, bool two_sided) {
  // Ranges of rates are there to catch slips of the pen, and have another unit.
  const ParameterSpec& strength = effects::effects().find(effect).parameters.front();
  const bool pure = strength.unit.empty();
  const double any = std::numeric_limits<double>::infinity();
  const double least = pure ? strength.min : two_sided ? -any : 0, most = pure ? strength.max : any;
  return {effect,
          1,
          strength_of(by_default(effects::effects().find(effect)), 0),
          step,
          effects::is_rate(strength.unit),
          two_sided,
          least,
          most};
}

Candidate of_mobility(const std::string& effect, double step, bool two_sided) {
  Candidate candidate = by_strength(effect, step, two_sided);
  candidate.like_diffusion_ratio = true;
  return candidate;
}

// Flow that line tension drives, and flow that thermal forces drive.
constexpr char kFlow[] = "flow", kBrownianFlow[] = "brownian-flow";
std::size_t place_of_thermal() {
  return place_of("thermal", effects::effects().find(kFlow).parameters);
}

Candidate capillary_flow() {
  Candidate candidate = by_strength(kFlow, 1, false);
  candidate.physics = "flow of the membrane, which the line tension of rafts drives";
  return candidate;
}

Candidate brownian_flow() {
  const effects::EffectEntry& entry = effects::effects().find(kFlow);
  const std::size_t thermal = place_of_thermal();
  Candidate candidate = by_strength(kFlow, 1e-4, false);
  candidate.name = kBrownianFlow;
  candidate.term = strength_of(by_default(entry), thermal);
  candidate.rate = true;  // variances grow with time
  candidate.most = entry.parameters[thermal].max;
  candidate.parameter = thermal;
  candidate.random = true;
  candidate.physics = "flow of the membrane that thermal forces drive, so that rafts wander";
  return candidate;
}

bool is_like_sphere(const geometry::LevelSet& surface, const std::vector<Point>& places) {
  // The level set outlives the question.
  const geometry::LevelSetPtr shared(&surface, [](const geometry::LevelSet*) {});
  try {
    const geometry::StarSurface star(shared);
    for (const Point& x : places) (void)star.radius((x - star.centre()).normalized());
  } catch (const InputError&) {
    return false;
  }
  return true;
}

std::vector<double> coefficients_of_exchange(double rate, double target) {
  return {rate - rate * target, rate * target};
}

// k (c − c*) = a0 c + a1 (c − 1) with k = a0 + a1, c* = a1/k; uptake where a0 = 0.
Candidate exchange() {
  return {"exchange",
          2,
          [](const std::vector<double>& a) {
            const double rate = a[0] + a[1];
            return effects::EffectTerm{"exchange", {rate, rate != 0 ? a[1] / rate : 0}};
          },
          1e-3,
          true,
          false,
          0,
          std::numeric_limits<double>::infinity(),
          false,
          "uptake"};
}

std::vector<std::string> names_of(const std::vector<Candidate>& some) {
  std::vector<std::string> names;
  for (const Candidate& candidate : some) names.push_back(candidate.name);
  return names;
}

}  // namespace

double Candidate::within_range(double coefficient) const {
  return std::clamp(coefficient, least, most);
}

// New ones come last, as what chance does in blind cases goes by their places.
std::vector<Candidate> candidates() {
  return {by_strength("allen-cahn", 1e-3, false),
          by_strength("asymmetry", 1e-3, true),
          of_mobility("bulk-mobility", 1e-3, false),
          by_strength("cooling", 1e-5, true),
          by_strength("curvature", 1e-3, true),
          exchange(),
          by_strength("gravity", 1e-3, true),
          by_strength("line-tension", 1e-3, true),
          by_strength("mobility-contrast", 1e-3, true),
          of_mobility("mobility-exponent", 1e-3, true),
          by_strength("ohta-kawasaki", 1e-3, false),
          by_strength("uptake", 1e-3, true),
          capillary_flow(),
          brownian_flow()};
}

std::string effect_of(const Candidate& candidate) {
  return candidate.term(std::vector<double>(candidate.directions, 0)).effect;
}

std::optional<Candidate> find_candidate(const std::string& name) {
  for (const Candidate& candidate : candidates())
    if (candidate.name == name) return candidate;
  return {};
}

std::vector<Candidate> candidates_for(const problem::CahnHilliardModel& base,
                                      const geometry::LevelSet& surface,
                                      const std::vector<Point>& places,
                                      const std::vector<std::string>& without) {
  const bool curved = curvature_contrast(surface, places) > kCurved,
             flows = is_like_sphere(surface, places);
  std::vector<Candidate> result;
  for (const Candidate& candidate : candidates()) {
    const bool left_out =
        std::find(without.begin(), without.end(), candidate.name) != without.end();
    const bool fits =
        effects::has_unit_wells(base) || !effects::effects().find(effect_of(candidate)).unit_wells;
    if (!left_out && fits && (curved || candidate.name != "curvature") &&
        (flows || effect_of(candidate) != kFlow))
      result.push_back(candidate);
  }
  return result;
}

std::string candidate_name(const effects::EffectTerm& term) {
  const bool brownian =
      term.effect == kFlow && term.values.front() == 0 && term.values[place_of_thermal()] > 0;
  return brownian ? kBrownianFlow : term.effect;
}

Hypothesis::Part part_of(const effects::EffectTerm& term) {
  return part_of(term, candidate_name(term));
}

Hypothesis::Part part_of(const effects::EffectTerm& term, const std::string& candidate) {
  const std::optional<Candidate> found = find_candidate(candidate);
  if (!found)
    throw InputError("effect " + term.effect + ": its strength cannot be fitted (possible: " +
                     joined(names_of(candidates()), ", ") + ")");
  Hypothesis::Part part{*found, {term.values[found->parameter]}};
  if (found->directions == 1)
    part.candidate.term = strength_of(term, found->parameter);
  else
    part.coefficients = coefficients_of_exchange(term.values[0], term.values[1]);
  return part;
}

Hypothesis of_model(const std::vector<effects::EffectTerm>& own) {
  Hypothesis result;
  for (const effects::EffectTerm& term : own) result.parts.push_back(part_of(term));
  result.known = result.parts.size();
  return result;
}

bool are_one(const Candidate& a, const Candidate& b) {
  return a.special_case == b.name || b.special_case == a.name;
}

std::vector<Candidate> candidates_beside(const Hypothesis& own, std::vector<Candidate> all) {
  const auto taken = [&](const Candidate& candidate) {
    return std::any_of(own.parts.begin(), own.parts.end(), [&](const Hypothesis::Part& part) {
      return candidate.name == part.candidate.name || are_one(candidate, part.candidate);
    });
  };
  all.erase(std::remove_if(all.begin(), all.end(), taken), all.end());
  return all;
}

std::vector<effects::EffectTerm> Hypothesis::terms() const {
  std::vector<effects::EffectTerm> result;
  for (const Part& part : parts) result.push_back(part.candidate.term(part.coefficients));
  return result;
}

Eigen::Index Hypothesis::coefficients() const {
  Eigen::Index count = 0;
  for (const Part& part : parts) count += part.candidate.directions;
  return count;
}

bool Hypothesis::is_random() const {
  return std::any_of(parts.begin(), parts.end(), [](const Part& part) {
    return part.candidate.random && part.coefficients.front() > 0;
  });
}

std::string physics_of(const Hypothesis::Part& part) {
  return part.candidate.physics.empty()
             ? effects::physics_of(part.candidate.term(part.coefficients))
             : part.candidate.physics;
}

std::string Hypothesis::name() const {
  std::string text;
  for (std::size_t k = known; k < parts.size(); ++k)
    text += (text.empty() ? "" : " + ") + parts[k].candidate.name;
  return text;
}

bool Hypothesis::has(const std::string& effect) const {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const Part& part) { return part.candidate.name == effect; });
}

bool Hypothesis::contains(const Hypothesis& other) const {
  return std::equal(parts.begin(), parts.end(), other.parts.begin(), other.parts.end(),
                    [](const Part& own, const Part& others) {
                      const std::string& effect = others.candidate.name;
                      return own.candidate.name == effect || own.candidate.special_case == effect;
                    });
}

CoefficientForcing::CoefficientForcing(const problem::CahnHilliard& problem,
                                       const problem::CahnHilliardModel& model,
                                       const Hypothesis& hypothesis,
                                       const std::vector<Candidate>& more)
    : problem_(problem) {
  const auto space = std::shared_ptr<const fem::SurfaceSpace>(&problem.space(), [](auto*) {});
  const auto changed = [&](const Hypothesis& h) {
    return std::make_shared<const problem::CahnHilliard>(
        space, problem::without_noise(effects::with_effects(model, h.terms())));
  };
  Hypothesis extended = hypothesis;
  const auto add_pairs = [&](std::size_t part) {
    const Candidate& candidate = extended.parts[part].candidate;
    for (int d = 0; d < candidate.directions; ++d) {
      double& a = extended.parts[part].coefficients[d];
      const double at = a, step = std::max(candidate.step, 1e-3 * std::fabs(at));
      Pair pair;
      a = at + step;
      pair.plus = changed(extended);
      pair.distance = step;
      if (candidate.two_sided || at >= step) {
        a = at - step;
        pair.minus = changed(extended);
        pair.distance = 2 * step;
      }
      a = at;
      pairs_.push_back(pair);
    }
  };
  for (std::size_t part = 0; part < hypothesis.parts.size(); ++part) add_pairs(part);
  for (const Candidate& candidate : more) {
    extended.parts.push_back({candidate, std::vector<double>(candidate.directions, 0.0)});
    add_pairs(extended.parts.size() - 1);
    extended.parts.pop_back();
  }
}

Columns CoefficientForcing::operator()(double t, VecView y) const {
  const Vec no_rate = Vec::Zero(problem_.size());
  Columns forcing(problem_.size(), static_cast<Eigen::Index>(pairs_.size()));
  Vec here(problem_.size()), minus(problem_.size()), plus(problem_.size());
  bench::require(problem_.residual(t, y, no_rate, here));
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    bench::require(pairs_[k].plus->residual(t, y, no_rate, plus));
    if (pairs_[k].minus) bench::require(pairs_[k].minus->residual(t, y, no_rate, minus));
    forcing.col(static_cast<Eigen::Index>(k)) =
        (plus - (pairs_[k].minus ? minus : here)) / pairs_[k].distance;
  }
  return forcing;
}

}  // namespace traceraft::assimilation
