// Numerical failure is a value: integrators act on it, nothing throws across a time step.
#pragma once

#include <string>
#include <utility>

namespace traceraft {

enum class Outcome {
  ok,     // the result can be used
  retry,  // not usable, but a smaller step, a fresh factorisation or a fallback may succeed
  fatal   // no retry can help
};

struct [[nodiscard]] Status {
  Outcome outcome = Outcome::ok;
  std::string why;  // empty when ok; otherwise one line for the user

  bool ok() const { return outcome == Outcome::ok; }

  static Status retry(std::string why) { return {Outcome::retry, std::move(why)}; }
  static Status fatal(std::string why) { return {Outcome::fatal, std::move(why)}; }
};

}  // namespace traceraft
