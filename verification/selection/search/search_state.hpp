// The search for what is missing as a value: a step makes the next state of one.
#pragma once

#include <map>
#include <utility>

#include "verification/selection/search/explanation.hpp"

namespace traceraft::selection {

// The steps, and what follows each.
enum class SearchStep {
  start,         // D of the base model, roughly → calibrate; rafts at rest → done
  calibrate,     // fit noise, D and effects of the model as it stands → eliminate, screen
  eliminate,     // drop an effect that the model does as well without → calibrate, screen
  screen,        // score tests of all candidates → refit, choose
  refit,         // fit the shortlist of them, one by one → choose
  choose,        // take the most probable one, or none → replace, compare_gaps, weigh
  replace,       // exchange effects for others that came near them → calibrate
  compare_gaps,  // leave what has a gap for rivals that have none → calibrate, weigh
  weigh,         // ask what is held out about the class, once → calibrate, confirm
  confirm,       // on another mesh, by another integrator → done
  done
};
inline constexpr std::array kSearchSteps{std::pair{SearchStep::start, "start"},
                                         std::pair{SearchStep::calibrate, "calibrate"},
                                         std::pair{SearchStep::eliminate, "eliminate"},
                                         std::pair{SearchStep::screen, "screen"},
                                         std::pair{SearchStep::refit, "refit"},
                                         std::pair{SearchStep::choose, "choose"},
                                         std::pair{SearchStep::replace, "replace"},
                                         std::pair{SearchStep::compare_gaps, "compare-gaps"},
                                         std::pair{SearchStep::weigh, "weigh"},
                                         std::pair{SearchStep::confirm, "confirm"},
                                         std::pair{SearchStep::done, "done"}};
std::string word_for(SearchStep step);

// Forecasts are of a model and a noise.
struct ForecastPoint {
  assimilation::NoiseModel noise;
  double diffusion_ratio = 1;
  assimilation::Hypothesis hypothesis;

  friend bool operator==(const ForecastPoint& a, const ForecastPoint& b);
};

// All that a search goes on from.
struct SearchState {
  SearchStep next = SearchStep::start;
  // Forecasts of the last calibration: of errors (ErrorMaps), and of the fields.
  ForecastPoint maps_at, fields_at;
  bool weighed = false;     // has what is held out been asked about the class?
  bool eliminated = false;  // has an effect been dropped in this round?
  int replacements = 0;     // of the hypothesis that was chosen last
  // Refits of the next step that an interrupted search has had, by their number in it.
  std::map<std::size_t, Refit> refits;
  Explanation so_far;
};

// Searches, from a state of the same data and request, until it is done. The vesicles are of one
// radius and one membrane. Throws std::runtime_error if the base model cannot be advanced.
Explanation explain_fields(const std::vector<assimilation::FieldSeries>& series,
                           const ExplainRequest& request, SearchState from = {});

}  // namespace traceraft::selection
