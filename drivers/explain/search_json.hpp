// The state of a search as JSON: everything that it goes on from, at full precision.
#pragma once

#include "drivers/input/json_file.hpp"
#include "verification/selection/search/search_state.hpp"

namespace traceraft::explain {

input::Json search_json(const selection::SearchState& state);
// The state of a search with that base model. Throws DamagedFile for unknown names and sizes that
// do not fit each other, and what the JSON library throws for anything else that is not a search.
selection::SearchState search_from(const input::Json& json, const problem::CahnHilliardModel& base);

}  // namespace traceraft::explain
