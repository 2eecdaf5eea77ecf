// From series of vesicles (perimeter, number of rafts, their share of the area) to classes of
// effects that the model may lack: they say less than fields, and this says how much less.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "verification/selection/search/judgement.hpp"
#include "verification/selection/series/series_gains.hpp"
#include "verification/selection/series/series_unit_range.hpp"

namespace traceraft::selection {

struct SeriesRequest {
  likelihood::UnitPrior unit;  // R²/D of the model, and the factor within which D is known
  int replicates = 199;        // of data that the base model would give
  double false_alarms = 0.05;  // with nothing missing, that something seems to be named
};

// The share of the false alarms that trends which no effect explains may make: such a trend has to
// be that much less probable.
inline constexpr double kTrendLevel = 0.4;

struct SeriesScore {
  std::string effect;
  double gain;       // 2 ln of the likelihood ratio, the effect's strength being free
  double null_mean;  // the same of data of the base model, on average
  double p;          // share of these in which any effect gains as much, for what it is
  double trend_p;    // share of these that leave as large a trend as the data do with the effect
  double ln_unit;    // of R²/D in seconds, with the effect
  double amplitude;  // of its fit
  double value,      // the strength, in R and R²/D
      sigma;         // its standard deviation
  double low, high;  // its 95 % bounds
  bool bounded;      // they are within what has been simulated
  std::size_t
      level;        // of the candidate, nearest to the fit; the typical one if that has none of it
  double vesicles;  // so many as these show it at that level; see times_needed
  observations::Quantity telling;  // what shows it best
};

// Two classes that the data do not tell apart.
struct SeriesTie {
  std::string effect, other;
  double vesicles;                 // so many would
  observations::Quantity telling;  // above all by that
};

struct SeriesExplanation {
  Finding finding;
  int vesicles, looks;
  double p;                      // that the best score is noise
  double trend_p;                // that what is left of the best model is
  likelihood::EnsembleFit base;  // without any effect
  double unit_deviation;         // of its ln_unit, from data of the base model
  bool unit_at_end;              // it would be further away if the fit let it
  bool unit_told;                // is it known much better than before?
  UnitRange unit_range;  // whatever effect is at work: of the named ones, of all if none is named
  std::vector<SeriesOffset> offsets;              // of the measurements beside it
  std::vector<SeriesOffset> best_offsets;         // beside the model with the first of the scores
  std::vector<SeriesScore> scores;                // most telling first
  std::vector<std::vector<std::string>> classes;  // effects that change series alike
  std::vector<std::vector<std::string>> named;    // those of them that explain the data
  std::vector<SeriesTie> ties;                    // between the best effect and other classes
};

// Throws InputError if there are fewer than three, before anything is simulated for them.
void refuse_vesicles(const observations::MeasuredVesicles& data);

// Throws InputError if there are fewer than three vesicles, or runs.
SeriesExplanation explain_series(const observations::MeasuredVesicles& data,
                                 const std::vector<observations::History>& base,
                                 const std::vector<SeriesCandidate>& candidates,
                                 const SeriesRequest& request);

}  // namespace traceraft::selection
