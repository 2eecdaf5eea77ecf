// Effects that turn out to be none: with the noise and the errors of the model that has them.
#pragma once

#include <string>

#include "verification/explain/search/search.hpp"

namespace traceraft {

// As long as one of the model's effects is not resolved, and the model is more probable without it
// (with what is held out, too), it is dropped, and so it is by the rivals; these stay rivals if
// they explain the data as well then. `pass`: of the model (next_pass). Returns that of what is
// left. Throws std::runtime_error if its forecast fails.
FilterResult drop_what_is_none(Search& search, FilterResult pass);

bool was_dropped(const Explanation& result, const std::string& effect);

}  // namespace traceraft
