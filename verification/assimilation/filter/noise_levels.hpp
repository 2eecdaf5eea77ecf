// How noisy a series of fields is, by what it states of that and by how far it lies from forecasts.
#pragma once

#include "verification/assimilation/filter/field_filter.hpp"

namespace traceraft::assimilation {

// Standard deviation of the values that count, in c: their root mean square. First snapshots are
// left out, as nothing is known of their own noise.
double noise_of(const FilterProblems& data);

// Standard deviation of c over all measured values, without the noise.
double contrast_of(const FilterProblems& data);

// The noise that the innovations of a pass have becomes that of the measurements: one for all of a
// vesicle's snapshots, in units of the deviations that they state, but for those that state them
// wrongly.
void fit_noise(FilterProblems& data, const FilterResult& pass);

// The same as fit_noise, from the noise of each vesicle's snapshots but the first, in units of
// their deviations.
void set_noise(FilterProblems& data, const std::vector<std::vector<double>>& own);

// All that is estimated of the noise, a vesicle after the other.
struct NoiseModel {
  // The noise of each snapshot of each vesicle, in units of its deviations.
  std::vector<std::vector<double>> levels;
  // The noise of each vesicle's first snapshot that its field was estimated with, likewise.
  std::vector<double> first;
  NoiseCorrelation correlation;  // of the noise, the same for all vesicles

  friend bool operator==(const NoiseModel& a, const NoiseModel& b);
};

NoiseModel noise_model(const FilterProblems& data);
// Throws std::runtime_error if the first fields cannot be estimated with it.
void set_noise_model(const NoiseModel& noise, const problem::CahnHilliardModel& base,
                     const FilterSettings& settings, FilterProblems& data);

// The same as fit_noise, with what neighbours share of the noise, which is common to all snapshots:
// as the innovations have it beside what they leave unknown of the states and of the model. True if
// its correlation is another one now, so that forecasts and their errors have to be found anew; the
// first fields are. Throws std::runtime_error if they cannot be.
bool fit_noise_covariance(FilterProblems& data, const FilterResult& pass,
                          const problem::CahnHilliardModel& base, const FilterSettings& settings);

}  // namespace traceraft::assimilation
