#include "drivers/run/checked_options.hpp"

#include <algorithm>

#include "kernel/core/named_list.hpp"

namespace traceraft {

std::string one_of(const Configuration& configuration, const char* option, const char* kind,
                   const std::vector<std::string>& words) {
  const std::string word = configuration.text(option);
  if (std::find(words.begin(), words.end(), word) == words.end())
    throw InputError(configuration.where(option) + ": " + unknown_name_message(kind, word, words));
  return word;
}

}  // namespace traceraft
