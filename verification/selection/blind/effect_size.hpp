// How strong hidden effects have to be to make the gap that is asked for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "verification/selection/blind/blind_looks.hpp"
#include "verification/selection/blind/blind_simulation.hpp"

namespace traceraft::assimilation {
struct Candidate;
}

namespace traceraft::selection {

// Effects that can be hidden: those that a sphere shows.
std::vector<std::string> effects_to_hide();
// Throws InputError for another one.
assimilation::Candidate candidate_to_hide(const std::string& effect);

// Found on a mesh that is coarser than the truth's: strengths need not be exact.
class EffectSizing {
 public:
  // Simulates the base. Throws std::runtime_error if that fails, InputError if it has no rafts.
  explicit EffectSizing(const BlindRequest& request);

  // The effect with the strength at which it makes the request's gap, or the largest one that it
  // may have. `number`: of the random numbers that decide upon signs and mixtures. Throws
  // std::runtime_error if a simulation fails, InputError for an effect that cannot be hidden.
  effects::EffectTerm term(const std::string& effect, std::uint64_t number) const;
  // Its coefficients in these proportions.
  effects::EffectTerm term(const std::string& effect, std::vector<double> coefficients) const;

 private:
  effects::EffectTerm drawn_often(effects::EffectTerm term) const;
  // Coefficients in a random direction that the effect allows.
  std::vector<double> random_coefficients(const assimilation::Candidate& candidate,
                                          std::uint64_t number) const;
  // Root mean square change of c that the effect makes from each of the base's snapshots to the
  // next, in units of the standard deviation of c.
  double gap_of(const effects::EffectTerm& term) const;

  BlindRequest request_;
  BlindLooks looks_;
  BlindMethod method_;
  std::vector<Vec> snapshots_, next_;  // of the base; what becomes of each until the next time
};

// Throws InputError where the standard deviation of c is not that of rafts.
void refuse_without_rafts(double contrast);

// The request's effects.
std::vector<effects::EffectTerm> size_effects(const BlindRequest& request);

}  // namespace traceraft::selection
