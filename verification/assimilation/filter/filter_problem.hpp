// The data that a model is held against: a series of measured fields, on the mesh of the model.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "kernel/linear/linear_solver.hpp"
#include "kernel/problem/cahn_hilliard.hpp"
#include "verification/assimilation/fields/blur.hpp"
#include "verification/assimilation/fields/noise_correlation.hpp"
#include "verification/assimilation/forecast/gap_patterns.hpp"
#include "verification/assimilation/forecast/resolved_forecast.hpp"

namespace traceraft::assimilation {

struct FilterSettings {
  int rank = 240;         // directions in which the state is uncertain
  int replicates = 199;   // of the noise, through everything that is linear
  int tangent_steps = 3;  // between two snapshots, for derivatives by parameters
  int error_steps = 2;    // the same for errors of the state
  int random_steps = 3;   // the same for random effects, and at most so many fields of one:
  int random_rank = 120;
  double gain = 0.1;    // standard deviation of the unknown scale of each snapshot's values
  double offset = 0.1;  // the same of their unknown zero, in units of the distance of the phases
  double first_gain = 0.1,  // `gain` of the first snapshot, which forecasts begin with
      first_offset = 0.1;   // `offset` of the first snapshot
  // Standard deviation of the point spread function of the images, in R: they have it, or none.
  double blur = 0;
  NoiseCorrelation correlation = {};  // of the noise, that its estimate begins with
  // Standard deviation of the angle (rad) by which a vesicle may turn between two snapshots.
  double turn = 0.05;
  int gap_degree = 6;  // of the polynomials that gaps are sought as
  // Standard deviation of ln D of the base model, as far as D is known from elsewhere.
  double diffusion_ratio_doubt = std::numeric_limits<double>::infinity();
  std::string integrator = "ida";  // of forecasts
};

// Number of the directions of errors of the first snapshot's state that are of its scale and its
// zero.
inline constexpr Eigen::Index kFirstFrame = 2;

// The rotation by which a vesicle has turned since the snapshot before.
struct SnapshotTurn {
  Eigen::Matrix3d rotation;
  MeshTransfer own,  // turns fields on the model's mesh
      finest;        // turns fields on the finest mesh
};

// Everything about the series of one vesicle that does not depend on parameters.
struct FilterProblem {
  std::size_t vesicle;  // its number
  FieldSeries series;   // without outliers
  std::size_t outliers = 0;
  std::shared_ptr<const ThreadTeam> team;
  bench::SpacePtr space;  // of one thread
  bool sphere = false;    // is that what the surface is?
  std::shared_ptr<const FinerMeshes> finer;
  fem::EigenMatrix mass;               // stabilised, on `space`
  std::vector<NoisyValues> snapshots;  // of the series, on `space`
  FinerTraces finer_traces;
  std::size_t train = 0;         // snapshots that count
  FieldPrior prior{};            // of the first field, as white noise would have it
  FieldEstimate first;           // of the first snapshot, whose scale and zero begin its errors
  Vec first_resolved;            // its field on the finest mesh
  std::vector<double> noise;     // of each snapshot, in units of its deviations
  double first_noise = 0;        // that of the first one as `first` was estimated with
  NoiseCorrelation correlation;  // of that noise, between values of one snapshot
  std::vector<WhiteningPtr> whitening;  // by that, of each snapshot
  // The turn before each snapshot; nothing where it is no more than the settings' `turn` or so.
  std::vector<std::shared_ptr<const SnapshotTurn>> turns;
  std::shared_ptr<const GapPatterns> patterns;
  std::shared_ptr<const Blur> blur;  // if the images have one
  linear::LinearSolverFactory tangent_solver;
  MakeForecaster make_integrator;
  // Effects with the variance 1 that the state may be moved by at random.
  struct Random {
    std::string name;
    std::shared_ptr<const problem::RandomEffect> effect;
  };
  std::vector<Random> random;

  double time(std::size_t snapshot) const { return series.snapshots[snapshot].time; }
};

using FilterProblems = std::vector<FilterProblem>;

// A field on `space` at the time `end`, from that at `begin`. Throws std::runtime_error if the
// problem cannot be advanced.
Vec advanced(const FilterProblem& data, const problem::CahnHilliard& problem, VecView field,
             double begin, double end);

// The number of values that were measured and count. First snapshots are left out.
double count_values(const FilterProblems& data);

// The noise of the snapshots of `data`, whose levels are known, has that correlation from now on.
// The first field is estimated anew. Throws std::runtime_error if it cannot be.
void set_correlation(const NoiseCorrelation& correlation, const problem::CahnHilliardModel& base,
                     const FilterSettings& settings, FilterProblem& data);

// The problems of all vesicles, one for each series; they share their meshes. `hold_out`: the last
// of four snapshots or more is forecast, but counts for nothing. Throws InputError for places that
// are off the surface, and where more than a twentieth of the values are outliers.
FilterProblems make_filter_problems(const std::vector<FieldSeries>& series,
                                    const geometry::LevelSetPtr& surface,
                                    const problem::CahnHilliardModel& base, int cells, int threads,
                                    bool hold_out, const FilterSettings& settings);

}  // namespace traceraft::assimilation
