#include "drivers/run/checked_options.hpp"

#include <algorithm>

#include "kernel/core/named_list.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::run {
namespace {

constexpr double kShortestTime = 1e-100, kLongestTime = 1e100;  // in R²/D
// Steps that are shorter, over the end of the run, are lost when they are added to its time.
constexpr double kLeastPart = 1e-14;

}  // namespace

std::string one_of(const config::Configuration& configuration,
                   std::string config::RunOptions::*option, const char* kind) {
  const std::vector<std::string>& words = config::run_option(option).words;
  const std::string& word = configuration.options().*option;
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw InputError(configuration.where(option) + ": " + unknown_name_message(kind, word, words));
  return word;
}

bool is_of_discs(const config::Configuration& configuration) {
  return one_of(configuration, &config::RunOptions::model, "model") == "discs";
}

void refuse_discs(const config::Configuration& configuration) {
  if (is_of_discs(configuration))
    throw InputError(configuration.where(&config::RunOptions::model) +
                     ": discs have no field; choose the model field");
}

void refuse_times_out_of_range(const config::Configuration& configuration) {
  const double unit = configuration.units().time(), end = configuration.options().t_end;
  const auto require = [&](const config::OptionSpec& spec, double value, double least) {
    const double most = kLongestTime * unit;
    if ((value == 0 && spec.min == 0) || (value >= least && value <= most)) return;
    throw InputError(configuration.where(spec.name) + ": " + format_number(value) +
                     " is too short or too long to compute with (allowed: " +
                     (spec.min == 0 ? "0, or " : "") + formatted("%.3g to %.3g)", least, most));
  };
  for (const config::OptionSpec& spec : config::run_options()) {
    if (spec.dimension != config::Dimension::time) continue;
    for (const double value : configuration.numbers(spec))
      require(spec, value, kShortestTime * unit);
  }
  for (const char* longest : {"max-step", "ida-maxstep"})
    for (const double value : configuration.numbers(config::run_option(longest)))
      require(config::run_option(longest), value, kLeastPart * end);
}

}  // namespace traceraft::run
