// The steps of a search (SearchStep): each takes a state and returns the next one.
#pragma once

#include "verification/selection/search/search.hpp"

namespace traceraft::selection {

// The step that is next, whichever it is.
SearchState next_state(Search& search, SearchState state);

// D of the base model, to some percent.
SearchState start(Search& search, SearchState state);

// Noise, D and strengths of the model as it stands. Throws std::runtime_error if the base model
// cannot be advanced; where a later one cannot, the search stops.
SearchState calibrate(Search& search, SearchState state);
// The same of a model that was found. Throws std::runtime_error if it cannot be advanced.
SearchState calibrate_found(Search& search, SearchState state);

// Backward elimination. An effect that is not resolved, and without which the model is more
// probable, with what is held out, too, is dropped; the model is calibrated anew then. Rivals that
// explain the data as well without it stay rivals.
SearchState eliminate(Search& search, SearchState state);

// Score tests of all candidates: a new round.
SearchState screen_candidates(Search& search, SearchState state);

// The likelihood of each candidate of the shortlist, refitted beside what is known.
SearchState refit_shortlist(Search& search, SearchState state);

// Takes the most probable candidate, or says why none is taken (judgement.hpp).
SearchState choose(Search& search, SearchState state);

// Compares what was found with its neighbours (neighbours.hpp), and goes over to the best one.
SearchState replace(Search& search, SearchState state);

// Hypotheses that explain what counts as well as each other may leave different gaps: what leaves
// one is left for the rivals that leave none, in their order.
SearchState compare_gaps(Search& search, SearchState state);
// Is there a gap of any shape beside that fit, too, with the noise and the errors that it has? Not
// if it cannot be forecast with.
bool leaves_gap(Search& search, const SearchState& state, const Refit& fit);

// Held-out snapshots decide, once, between the members of a class that is open. The search goes on
// beside another member if that is more probable by more than hardly anything.
SearchState weigh(Search& search, SearchState state);
// Is `one` as probable as `other`, each refitted to all that was measured, held-out snapshots
// included? False where a refit fails.
bool is_as_probable(Search& search, const SearchState& state, const Refit& one, const Refit& other);
// A hypothesis, refitted to the snapshots that count, with the noise of `data`.
Refit refit_of(const assimilation::FilterProblems& data, const problem::CahnHilliardModel& base,
               const Refit& member, assimilation::FilterSettings settings);

// Repeats the comparison on another mesh and by another integrator (rerun.hpp).
SearchState confirm(Search& search, SearchState state);

}  // namespace traceraft::selection
