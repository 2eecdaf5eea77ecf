// Holds a model against a series of measured fields: forecasts every snapshot from those before it,
// compares, corrects, and keeps account of what the comparison can and cannot blame on the state.
//
// The extended Kalman filter with the covariance of the state in a moving basis of a few hundred
// directions. Beside the state it carries its derivatives by parameters θ of the model; the product
// of the probabilities of all innovations is then, to first order in θ, the likelihood of θ with
// the unknown state integrated out.
#pragma once

#include <optional>
#include <vector>

#include "verification/bench.hpp"
#include "verification/explain/candidates.hpp"
#include "verification/explain/field_estimate.hpp"
#include "verification/explain/field_series.hpp"
#include "verification/explain/tangent_flow.hpp"

namespace traceraft {

struct FilterSettings {
  int rank = 240;         // directions in which the state is uncertain
  int replicates = 199;   // of the noise, through everything that is linear
  int tangent_steps = 8;  // between two snapshots, for derivatives by parameters
  int error_steps = 3;    // the same for errors of the state
  double gain = 0.1;      // standard deviations of the scale and of the zero of each snapshot's
  double offset = 0.1;    // values, as far as they are unknown
  double turn = 0.05;     // of the angle by which a vesicle may have turned between two snapshots
  int gap_degree = 6;     // of the polynomials that gaps are sought as
};

// Everything about a series that does not depend on parameters: where it was measured, on the mesh
// of the model and on a finer one that shows what the model's own mesh does.
struct FilterProblem {
  std::shared_ptr<const ThreadTeam> team;
  SpacePtr space, fine;                // of one thread
  std::vector<NoisyValues> snapshots;  // on `space`
  std::vector<double> times;           // in units of R²/D of the base model
  std::size_t train = 0;               // snapshots that count
  std::vector<PointTrace> fine_trace;  // where they were measured, on `fine`
  PointTrace to_fine, from_fine;       // nodal values from one mesh to the other
  FieldEstimate first;                 // of the first snapshot
  double noise;                        // of all of them
  LinearSolverFactory tangent_solver;
  std::function<IntegratorPtr(const DaeProblem&, const SurfaceSpace&)> make_integrator;
};
// `held_out`: so many snapshots at the end are forecast, but count for nothing.
FilterProblem make_filter_problem(const FieldSeries& series, const LevelSet& surface,
                                  double epsilon, int cells, int fine_cells, int threads,
                                  std::size_t held_out, const FilterSettings& settings);

// Linear maps of errors along one series of forecasts: found once, used again for all that stay
// close to it.
struct ErrorMaps {
  std::vector<Columns> basis, image;  // per interval; the basis is orthonormal in M̃
  std::vector<Columns> replicates;    // errors of the forecast at its end, a column for each
  struct MeshError {
    Vec field;   // at the nodes
    Vec values;  // where the next snapshot was measured
  };
  std::vector<MeshError> mesh_error;  // of the forecast, extrapolated from a finer mesh
};

// What one snapshot says.
struct Innovation {
  double time;
  Vec forecast;        // c where it was measured
  Vec values;          // measured minus forecast, in units of the noise
  Columns state;       // G: what uncertain directions do to the values: covariance 1 + G Gᵀ
  Columns gaps;        // orthonormal patterns that a gap could have, before weighting
  Columns parameters;  // X: derivatives of the forecast by the parameters
  Columns replicates;  // values of noise alone
  double weighted_squares = 0;  // νᵀ S⁻¹ ν, one per value on average
  double model_error;  // size of the state's error that is no noise, per step, in units of c
};

struct FilterResult {
  std::vector<Innovation> innovations;
  Eigen::MatrixXd information;  // Σ Xᵀ S⁻¹ X
  Vec score;                    // Σ Xᵀ S⁻¹ ν
  Eigen::MatrixXd null_scores;  // the same of the replicates, a column for each
  double deviance = 0;          // Σ νᵀ S⁻¹ ν + ln |S|
  double gap = 0;               // Σ of the part of ν that smooth patterns explain, squared
  Vec null_gaps;                // the same of the replicates
  std::vector<Vec> states;      // after correction, at every snapshot
};

// What is held against the measurements.
struct FilterModel {
  CahnHilliardModel base;
  double pace = 1;                  // D over that of the base model
  Hypothesis hypothesis;            // effects that the model has
  std::vector<Candidate> screened;  // effects it might have: derivatives at 0
};

// Parameters: ln D first, the share of the error of the mesh second, then the coefficients of the
// hypothesis and those of the screened candidates.
inline constexpr int kPace = 0, kMeshError = 1, kFirstParameter = 2;

// Model errors are sized by the innovations themselves, snapshot by snapshot, unless `model_errors`
// says how large they are. `maps` are filled if they are empty. Throws std::runtime_error if a
// forecast fails.
FilterResult filter_fields(const FilterProblem& data, const FilterModel& model,
                           const FilterSettings& settings, ErrorMaps& maps,
                           const std::vector<double>& model_errors = {});

}  // namespace traceraft
