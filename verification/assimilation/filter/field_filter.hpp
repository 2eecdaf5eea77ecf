// Holds a model against a series of measured fields: forecasts every snapshot from those before it,
// compares, corrects, and keeps account of what the comparison can and cannot blame on the state.
//
// The extended Kalman filter with the covariance of the state in a moving basis of a few hundred
// directions. Beside the state it carries its derivatives by parameters θ of the model; the product
// of the probabilities of all innovations is then, to first order in θ, the likelihood of θ with
// the unknown state integrated out.
#pragma once

#include <cmath>
#include <vector>

#include "verification/assimilation/filter/filter_problem.hpp"
#include "verification/assimilation/filter/innovation.hpp"
#include "verification/assimilation/forecast/candidates.hpp"

namespace traceraft::assimilation {

// Linear maps of errors along one series of forecasts: found once, used again for all that stay
// close to it.
struct ErrorMaps {
  std::vector<Columns> basis,       // per interval, nodes × directions, orthonormal in M̃
      image;                        // per interval, of the same shape: the basis at its end
  std::vector<Columns> replicates;  // errors of the forecast at its end, nodes × replicates
  std::vector<ResolvedForecast::End> mesh_error;  // what the forecast lacks on its own mesh
  // What random effects with the variance 1 add, per interval and effect: nodes × fields.
  std::vector<std::vector<Columns>> random;
  std::vector<double> duration;  // of each interval, in units of the model's time

  std::size_t intervals() const { return basis.size(); }
};

// The change of ln D up to which maps are used again. Further away errors of states grow and fade
// in another way, and maps are found anew.
inline constexpr double kMapsReach = 0.5;
inline bool maps_reach(double diffusion_ratio, double diffusion_ratio_of_maps) {
  return std::fabs(std::log(diffusion_ratio / diffusion_ratio_of_maps)) < kMapsReach;
}

struct FilterResult {
  std::vector<Innovation> innovations;
  Eigen::MatrixXd information;  // Σ Xᵀ S⁻¹ X, parameters × parameters
  Vec score;                    // Σ Xᵀ S⁻¹ ν, one per parameter
  Eigen::MatrixXd null_scores;  // parameters × replicates: the score of each replicate
  double deviance = 0;          // Σ νᵀ S⁻¹ ν + ln |S|
  // Score and information (its diagonal) of the variances of screened effects, if the model has no
  // other errors: those may look like a random effect. 0 for other parameters.
  Vec variance_score, variance_information;
  // explained_parts of each snapshot that counts, patterns × (1 + parameters + replicates): of its
  // values, its parameters and its replicates. Empty if there are no replicates.
  std::vector<Columns> gap_parts,
      heldout_gap_parts;  // the same of each snapshot that is held out
};

// The model that is held against the measurements.
struct FilterModel {
  problem::CahnHilliardModel base;
  double diffusion_ratio = 1;       // D over that of the base model
  Hypothesis hypothesis;            // effects that the model has
  std::vector<Candidate> screened;  // effects it might have: derivatives at 0
};

// Standard deviation of the share by which extrapolation to infinitely fine meshes is wrong.
inline constexpr double kMeshDoubt = 0.5;

// Vesicles have a state each and share the parameters. Model errors are sized by the innovations
// themselves, snapshot by snapshot. `maps`, one per vesicle, are filled if there are none. There
// are replicates, and what is counted of them, only where the settings want some. Throws
// std::runtime_error if a forecast fails.
FilterResult filter_fields(const FilterProblems& data, const FilterModel& model,
                           const FilterSettings& settings, std::vector<ErrorMaps>& maps);

}  // namespace traceraft::assimilation
