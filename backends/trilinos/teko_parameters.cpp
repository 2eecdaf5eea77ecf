#include "backends/trilinos/teko_parameters.hpp"

#include <Teuchos_XMLParameterListHelpers.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>
#include <vector>

#include "backends/trilinos/belos_method.hpp"
#include "backends/trilinos/inverse_library.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/named_list.hpp"

namespace traceraft::trilinos {
namespace {

using Teuchos::ParameterList;

std::string option(const TekoOptions& options, const char* name, const char* otherwise) {
  const auto found = options.find(name);
  return found == options.end() ? otherwise : found->second;
}

// Throws OptionError, which says what is wrong with one of the options.
[[noreturn]] void refuse(const char* option, const std::string& why) {
  throw OptionError(option, why);
}

// A name of ours or of a sublist of the user's.
std::string one_of(const TekoOptions& options, const char* name, const char* otherwise,
                   std::vector<std::string> names, const ParameterList& own = ParameterList()) {
  const std::string word = option(options, name, otherwise);
  for (auto entry = own.begin(); entry != own.end(); ++entry) names.push_back(own.name(entry));
  if (std::find(names.begin(), names.end(), word) == names.end())
    refuse(name, unknown_name_message(name, word, names));
  return word;
}

// The two lists that a file may have, of sublists that Teko or Belos know.
void refuse_other_lists(const std::string& path, const ParameterList& lists) {
  for (auto entry = lists.begin(); entry != lists.end(); ++entry) {
    const std::string& name = lists.name(entry);
    if (name != "Inverse Library" && name != "Belos")
      refuse("parameters",
             path + ": " + unknown_name_message("sublist", name, {"Inverse Library", "Belos"}));
    if (!lists.isSublist(name)) refuse("parameters", path + ": " + name + " is no sublist");
  }
}

// Teuchos calls itself for each list within a list.
int depth_of_lists(const std::string& text) {
  int depth = 0, deepest = 0;
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i + 1)) {
    const char kind = i + 1 < text.size() ? text[i + 1] : '>';
    if (kind == '?' || kind == '!') continue;
    const std::size_t end = text.find('>', i);
    const bool whole = end != std::string::npos && text[end - 1] == '/';
    if (kind == '/')
      --depth;
    else if (!whole)
      deepest = std::max(deepest, ++depth);
  }
  return deepest;
}

void refuse_inverses_without_type(const std::string& path, const ParameterList& inverses) {
  for (auto entry = inverses.begin(); entry != inverses.end(); ++entry)
    if (!inverses.isSublist(inverses.name(entry)) ||
        !inverses.sublist(inverses.name(entry)).isParameter("Type"))
      refuse("parameters", path + ": the inverse " + inverses.name(entry) +
                               " needs a sublist with the parameter Type");
}

void read_lists(TekoParameters& parameters) {
  const std::string& path = parameters.file;
  if (path.empty()) return;
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || text.str().empty())
    refuse("parameters", path + ": cannot be read: " + std::strerror(errno ? errno : ENODATA));
  parameters.checksum = std::hash<std::string>()(text.str());
  constexpr int kMostLists = 100;
  if (depth_of_lists(text.str()) > kMostLists)
    refuse("parameters", path + ": lists within lists, more than " + std::to_string(kMostLists));
  ParameterList lists;
  try {
    Teuchos::updateParametersFromXmlString(text.str(), Teuchos::ptrFromRef(lists));
  } catch (const std::exception& error) {
    const std::string why = error.what();
    refuse("parameters", path + ": no Teuchos parameter list: " + why.substr(0, why.find('\n')));
  }
  refuse_other_lists(path, lists);
  parameters.inverses = lists.sublist("Inverse Library");
  parameters.belos = lists.sublist("Belos");
  refuse_inverses_without_type(path, parameters.inverses);
}

}  // namespace

TekoParameters read_teko_parameters(const TekoOptions& options, int ranks) {
  TekoParameters parameters;
  parameters.file = option(options, "parameters", "");
  read_lists(parameters);
  const ParameterList& own = parameters.inverses;
  parameters.inverse = one_of(options, "inverse", "muelu", kTekoInverses, own);
  if (parameters.inverse == "direct" && ranks > 1)
    refuse("inverse", "direct works on one rank only; choose muelu or ifpack2");
  parameters.method = one_of(options, "method", "fgmres", kBelosMethods);
  parameters.preconditioner =
      one_of(options, "preconditioner", "two-solve", kTekoPreconditioners, own);
  parameters.always_new = one_of(options, "renewal", "worn", {"worn", "always"}) == "always";
  return parameters;
}

void refuse_lists(const TekoParameters& parameters, const std::exception& error) {
  const std::string complaint = teko_complaints();
  refuse("parameters", parameters.file + ": " + (complaint.empty() ? error.what() : complaint));
}

}  // namespace traceraft::trilinos
