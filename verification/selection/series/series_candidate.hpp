// An effect as series are asked for it: simulated vesicles with it, at one or more strengths.
#pragma once

#include <string>
#include <vector>

#include "verification/likelihood/ensemble_fit.hpp"

namespace traceraft::selection {

// Simulated vesicles with an effect; their seeds are those of the vesicles without it.
struct SeriesLevel {
  double strength;                          // of the parameter that is sought, with its sign
  std::vector<observations::History> runs;  // in units of R²/D
};

// An effect that changes little has one level, as its response is in proportion. One that decides
// how rafts coarsen has several, stronger and stronger.
struct SeriesCandidate {
  std::string effect;
  std::vector<SeriesLevel> levels;
  bool two_sided;  // with one level: may the strength have the other sign?
  // Is the strength a rate, in D/R²? Then it is looked for in 1/s, as D is not known.
  bool rate = false;
  std::size_t typical = 0;  // the level at which it is asked how many vesicles would show it

  bool has_one_level() const { return levels.size() == 1; }
  // The strength at an amplitude of the fit (EnsembleModel), and its derivative. Between levels its
  // logarithm is linear, below the first one the strength is.
  double strength_at(double amplitude) const;
  double slope_at(double amplitude) const;
  // The standard deviation of the strength. That of a rate is for the unit of the fit, and includes
  // what is not known of the unit.
  double deviation(const likelihood::EnsembleFit& fit) const;
};

}  // namespace traceraft::selection
