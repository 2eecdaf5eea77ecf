// Effects as small changes of a model: what a data set is asked to choose from.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/effects/effects.hpp"
#include "verification/assimilation/forecast/tangent_flow.hpp"

namespace traceraft::assimilation {

// A candidate has one coefficient per direction. Its terms are linear in the coefficients near 0:
// the effect at coefficients a is term(a).
struct Candidate {
  std::string name;  // that of the effect, but where an effect is two candidates
  int directions;
  std::function<effects::EffectTerm(const std::vector<double>& coefficients)> term;
  // Coefficients that are small: for the derivative at 0.
  double step;
  bool rate;           // are the coefficients rates? They go with 1/time.
  bool two_sided;      // may the coefficients be negative?
  double least, most;  // that each of them may be
  // Does it make the mobility as a whole larger or smaller? Another D takes its place near 0, so
  // there is next to nothing to gain there, however much there is further on.
  bool like_diffusion_ratio = false;
  std::string special_case = {};  // a candidate that it is at the limit of its coefficients
  // The place of the first coefficient's parameter among those of the effect.
  std::size_t parameter = 0;
  // Is the coefficient the variance of a random effect? Forecasts do not change with it, but their
  // errors do.
  bool random = false;
  std::string physics = {};  // in words, where those of the effect are of both of its candidates

  double within_range(double coefficient) const;
};

// The effect that it is of.
std::string effect_of(const Candidate& candidate);

// All effects of the kernel that deterministic data of one vesicle can tell from the base model.
// Left out: rotation (always a nuisance) and thermal (noise of every point).
std::vector<Candidate> candidates();
std::optional<Candidate> find_candidate(const std::string& name);

// Those that a model on a surface may lack, near `places`, but for effects that are not to be
// looked for. On a mesh even a sphere is curved differently from place to place, in a pattern that
// resembles nothing but is not noise: where curvature hardly varies it is none of them. Flow needs
// a surface like a sphere.
std::vector<Candidate> candidates_for(const problem::CahnHilliardModel& base,
                                      const geometry::LevelSet& surface,
                                      const std::vector<Point>& places,
                                      const std::vector<std::string>& without);

// Effects with coefficients: those that a model has, and what is held to be missing in it.
struct Hypothesis {
  struct Part {
    Candidate candidate;
    std::vector<double> coefficients;
  };
  std::vector<Part> parts;
  std::size_t known = 0;  // so many of them, the first, are the model's own

  std::size_t added() const { return parts.size() - known; }
  std::vector<effects::EffectTerm> terms() const;
  Eigen::Index coefficients() const;
  bool is_random() const;    // is any of its effects, with a strength beyond 0?
  std::string name() const;  // of the effects that it adds
  bool has(const std::string& effect) const;
  // Is the other one this one at a limit of its coefficients?
  bool contains(const Hypothesis& other) const;
};

// Is one a special case of the other? Beside each other data do not tell their strengths.
bool are_one(const Candidate& a, const Candidate& b);
// Without what a model has, and what is one with that.
std::vector<Candidate> candidates_beside(const Hypothesis& own, std::vector<Candidate> all);

// One of a model's own: its strength is a coefficient, other parameters stay as they are. Throws
// InputError for an effect that is none of the candidates.
Hypothesis::Part part_of(const effects::EffectTerm& term);
Hypothesis::Part part_of(const effects::EffectTerm& term, const std::string& candidate);
// What it is, by the sign of its strength.
std::string physics_of(const Hypothesis::Part& part);
// The candidate that an effect is of: of the two that flow is, by the strength that is not 0.
std::string candidate_name(const effects::EffectTerm& term);
Hypothesis of_model(const std::vector<effects::EffectTerm>& own);  // all of them known

// ∂F/∂coefficient: for all coefficients of a hypothesis, then for those of more candidates at 0.
// By differences, which are exact where F is linear in a coefficient.
class CoefficientForcing {
 public:
  // `problem` has the model with the hypothesis' effects, and must outlive this object.
  CoefficientForcing(const problem::CahnHilliard& problem, const problem::CahnHilliardModel& model,
                     const Hypothesis& hypothesis, const std::vector<Candidate>& more);
  Columns operator()(double t, VecView y) const;

 private:
  struct Pair {
    std::shared_ptr<const problem::CahnHilliard> plus, minus;  // no minus: the problem itself
    double distance;
  };
  const problem::CahnHilliard& problem_;
  std::vector<Pair> pairs_;
};

}  // namespace traceraft::assimilation
