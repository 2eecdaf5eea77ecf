// What tells the members of a class apart: the gaps that they leave, and all that was measured,
// what is held out included.
#pragma once

#include <vector>

#include "verification/explain/search/search.hpp"

namespace traceraft {

// Is there a gap of any shape beside that one, too, with the noise and the errors that it has? Not
// if it cannot be forecast with. The search is then what it was, but for the maps of its forecasts.
bool leaves_gap(Search& search, const Refit& fit);

// Of hypotheses that explain what counts as well as each other some may foretell what is held out
// worse: the class is left to those that leave no gap, in their order. False if there is none.
bool leave_to_rivals(Search& search);

// What is held out counts, too, between the members of a class that is open; asked once. Returns
// whether another one than was found comes first then, by more than hardly anything, and all of its
// effects being resolved; the search goes on beside that.
bool tell_apart(Search& search);

// With all that was measured, what is held out included: is `one` as probable as `other`, each
// refitted? False where a refit fails.
bool is_as_probable(const Search& search, const Refit& one, const Refit& other);

// A hypothesis, refitted to the snapshots that count, with the noise of `data`.
Refit refit_of(const FilterProblems& data, const CahnHilliardModel& base, const Refit& member,
               FilterSettings settings);

}  // namespace traceraft
