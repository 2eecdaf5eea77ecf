#include "drivers/compare/compare_plan.hpp"

#include <algorithm>
#include <cmath>

#include "backends/list.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::compare {
namespace {

// The reference is this much tighter than the tightest run, and at least the second.
constexpr double kReferenceFactor = 100, kLeastReferenceFactor = 10;

template <class T>
void add_new(std::vector<T>& list, const T& item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

// Empty items do not count.
std::vector<std::string> words(const char* flag, const std::string& text) {
  std::vector<std::string> items = config::split_list(text);
  items.erase(std::remove(items.begin(), items.end(), ""), items.end());
  if (items.empty()) throw InputError(std::string(flag) + ": at least one is needed");
  return items;
}

template <class List>
void add_names(const List& list, const char* flag, const std::string& text,
               std::vector<std::string>& names) {
  if (text.empty()) return;
  for (const std::string& name : words(flag, text)) {
    try {
      (void)list.find(name);
    } catch (const InputError& error) {
      throw InputError(std::string(flag) + ": " + error.what());
    }
    add_new(names, name);
  }
}

void add_tolerances(const std::string& text, std::vector<double>& tolerances) {
  if (text.empty()) return;
  for (const std::string& word : words("--tolerances", text)) {
    const double tolerance = parse_number("--tolerances", word);
    if (!(tolerance >= kLeastTolerance && tolerance <= kLargestTolerance))
      throw InputError("--tolerances: " + word +
                       " is out of range (allowed: " + format_number(kLeastTolerance) + " to " +
                       format_number(kLargestTolerance) + ")");
    add_new(tolerances, tolerance);
  }
}

void add_ranks(const std::string& text, std::vector<int>& ranks) {
  if (text.empty()) return;
  for (const std::string& word : words("--ranks", text)) {
    const double number = parse_number("--ranks", word);
    if (!(number >= 1 && number <= kMostRanks && number == std::floor(number)))
      throw InputError("--ranks: " + word + " is out of range (allowed: 1 to " +
                       std::to_string(kMostRanks) + ", whole)");
    add_new(ranks, static_cast<int>(number));
  }
}

// The smallest of the values over a factor, as a person would write it.
double fraction_of_smallest(const std::vector<double>& values, double factor) {
  return std::stod(formatted("%.3g", *std::min_element(values.begin(), values.end()) / factor));
}

}  // namespace

double ComparePlan::reference() const {
  return reference_tolerance > 0
             ? reference_tolerance
             : std::max(kLeastTolerance, fraction_of_smallest(tolerances, kReferenceFactor));
}

ComparePlan extended_plan(const CompareRequest& request, const ComparePlan* before) {
  ComparePlan plan = before ? *before : ComparePlan{};
  add_names(backends::integrators(), "--integrators", request.integrators, plan.integrators);
  add_names(backends::linear_solvers(), "--linear-solvers", request.linear_solvers,
            plan.linear_solvers);
  add_tolerances(request.tolerances, plan.tolerances);
  add_ranks(request.ranks, plan.ranks);
  if (plan.integrators.empty()) plan.integrators = backends::integrators().names();
  if (plan.linear_solvers.empty()) plan.linear_solvers = {"block"};
  if (plan.tolerances.empty()) plan.tolerances = {1e-2, 3e-3, 1e-3};
  if (plan.ranks.empty()) plan.ranks = {1};
  if (request.repeat > 0) plan.repeat = request.repeat;
  if (request.time_limit >= 0) plan.time_limit = request.time_limit;
  if (request.target_error >= 0) plan.target_error = request.target_error;
  if (request.reference_tolerance > 0) plan.reference_tolerance = request.reference_tolerance;
  const double most = fraction_of_smallest(plan.tolerances, kLeastReferenceFactor);
  if (plan.reference() > most)
    throw InputError("--reference-tolerance: " + format_number(plan.reference()) +
                     " is too large for runs at " +
                     format_number(fraction_of_smallest(plan.tolerances, 1)) +
                     " (allowed: at most " + format_number(most) + ")");
  return plan;
}

std::string CompareJob::name() const {
  return integrator + "-" + linear_solver +
         (ranks > 1 ? "-" + std::to_string(ranks) + "ranks" : "") + "-" + format_number(tolerance) +
         "-" + std::to_string(repetition);
}

// A solver of one rank runs on one, whatever is asked for others.
static std::vector<int> ranks_for(const std::string& solver, const std::vector<int>& ranks) {
  return backends::linear_solvers().find(solver).distributed ? ranks : std::vector<int>{1};
}

std::vector<CompareJob> jobs_of(const ComparePlan& plan) {
  std::vector<CompareJob> jobs;
  for (int repetition = 1; repetition <= plan.repeat; ++repetition)
    for (const std::string& integrator : plan.integrators)
      for (const std::string& solver : plan.linear_solvers)
        for (const int ranks : ranks_for(solver, plan.ranks))
          for (const double tolerance : plan.tolerances)
            jobs.push_back({integrator, solver, tolerance, ranks, repetition});
  return jobs;
}

}  // namespace traceraft::compare
