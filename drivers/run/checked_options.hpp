// Options whose values need more than their type and range: what is wrong with one is said of where
// it was given.
#pragma once

#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::run {

// Runs `make`, so that what it finds wrong is said of the place where the option was given.
template <class Make>
auto with_option_context(const config::Configuration& configuration,
                         const config::OptionMember& option, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(configuration.where(option) + ": " + error.what());
  }
}

// The text of an option that must be one of its few words. Throws InputError.
std::string one_of(const config::Configuration& configuration,
                   std::string config::RunOptions::*option, const char* kind);

// Is it the model of discs? Throws InputError for a word that is no model.
bool is_of_discs(const config::Configuration& configuration);
// Throws InputError if it is, for commands that need the field.
void refuse_discs(const config::Configuration& configuration);

// Refuses times and steps that are too short or too long to compute with, in R²/D: integrators need
// inverses of steps, and squares of these, as doubles. Throws InputError.
void refuse_times_out_of_range(const config::Configuration& configuration);

}  // namespace traceraft::run
