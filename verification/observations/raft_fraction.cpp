#include "verification/observations/raft_fraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::observations {
namespace {

constexpr double kFarthest = 5;       // °C beyond the published temperatures
constexpr double kOffTieLine = 0.03;  // mole fraction that reading a diagram may be off

// The published data of a membrane: a tie line, and one more raft fraction whose tie line is not
// published.
struct PublishedMembrane {
  const char* name;
  double celsius;
  CoexistingPhases phases;
  double other_celsius, other_area;
};
constexpr PublishedMembrane kPublished[] = {
    {"3:1:20", 15, {{0.22, 0.43, 0.35}, {0.66, 0.16, 0.18}}, 10, 0.149},
    {"2:1:20", 20, {{0.20, 0.48, 0.32}, {0.60, 0.22, 0.18}}, 17.5, 0.199}};

std::array<double, 3> three_numbers(const std::string& context, std::string text,
                                    const std::string& such_as) {
  while (!text.empty() && (text.back() == '%' || text.back() == ' ')) text.pop_back();
  std::array<double, 3> numbers{};
  const std::size_t first = text.find(':'), second = text.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos ||
      text.find(':', second + 1) != std::string::npos)
    throw InputError(context + ": '" + text + "' is not " + such_as);
  numbers[0] = parse_number(context, text.substr(0, first));
  numbers[1] = parse_number(context, text.substr(first + 1, second - first - 1));
  numbers[2] = parse_number(context, text.substr(second + 1));
  if (*std::min_element(numbers.begin(), numbers.end()) < 0)
    throw InputError(context + ": a part of '" + text + "' is negative");
  return numbers;
}

bool equal(const LipidMixture& a, const LipidMixture& b) {
  return std::fabs(a.dopc - b.dopc) < 1e-6 && std::fabs(a.dppc - b.dppc) < 1e-6;
}

const PublishedMembrane& published(const LipidMixture& membrane) {
  std::string known;
  for (const PublishedMembrane& entry : kPublished) {
    if (equal(membrane, membrane_mixture("", entry.name))) return entry;
    known += (known.empty() ? "" : " and ") + std::string(entry.name);
  }
  throw InputError(
      "--composition: tie lines are known only for " + known +
      "; give the phases of another membrane to traceraft fraction by --ordered and --disordered");
}

// The area of the lipids of one phase, per lipid of the membrane.
double area(const LipidMixture& phase, double lipids, double celsius) {
  const double x = phase.cholesterol;
  return lipids * (area_of_dopc(x, celsius) * phase.dopc + area_of_dppc(x, celsius) * phase.dppc) /
         (1 - x);
}

}  // namespace

LipidMixture membrane_mixture(const std::string& context, const std::string& text) {
  const auto [dopc, dppc, percent] = three_numbers(
      context, text, "parts of DOPC : parts of DPPC : mol % of cholesterol, such as 3:1:20");
  if (!(dopc + dppc > 0) || percent >= 100)
    throw InputError(context + ": '" + text + "' has no phospholipid");
  if (percent > 0 && percent < 1 && text.find('%') == std::string::npos)
    throw InputError(context + ": '" + text + "' has " + format_number(percent) +
                     " mol % of cholesterol; for a fraction give " + format_number(100 * percent) +
                     " instead, or write '" + text + "%' if that is meant");
  const double rest = (1 - percent / 100) / (dopc + dppc);
  return {rest * dopc, rest * dppc, percent / 100};
}

bool same_membrane(const std::string& a, const std::string& b) {
  return equal(membrane_mixture("composition", a), membrane_mixture("composition", b));
}

LipidMixture phase_mixture(const std::string& context, const std::string& text) {
  const auto [dopc, dppc, cholesterol] =
      three_numbers(context, text, "mol % of DOPC : DPPC : cholesterol, such as 22:43:35");
  const double sum = dopc + dppc + cholesterol;
  if (!(dopc + dppc > 0)) throw InputError(context + ": '" + text + "' has no phospholipid");
  // Read off a diagram, percents do not add up to the last digit.
  if (std::fabs(sum - 100) > 1.5)
    throw InputError(context + ": '" + text + "' adds up to " + format_number(sum) + ", not 100");
  return {dopc / sum, dppc / sum, cholesterol / sum};
}

// The condensing effect of cholesterol on DOPC, and its contraction with temperature.
double area_of_dopc(double x, double celsius) {
  return 72 - 47.5 * x - 0.14 * (30 - celsius);
}

// The area of DPPC is known as a curve that is not published in numbers (Kheyfets, Mukhin,
// arXiv:1501.02727). This line is FITTED to the raft fractions of the two published tie lines, 10.8
// and 13.6 %. Lines from 42 - 4 x to 48 - 19.5 x do as well; without cholesterol they come up to
// the area in the gel, 47.9 at 20 C (Nagle, Tristram-Nagle 2000).
double area_of_dppc(double x, double celsius) {
  return 46 - 14.4 * x - 0.19 * (25 - celsius);
}

RaftFraction raft_fraction(const LipidMixture& membrane, const CoexistingPhases& phases,
                           double celsius) {
  // Lever rule, on DOPC as it differs most between the phases.
  const double lipids =
      (phases.disordered.dopc - membrane.dopc) / (phases.disordered.dopc - phases.ordered.dopc);
  if (!(lipids >= 0 && lipids <= 1))
    throw InputError(
        "--composition: its share of DOPC does not lie between those of the two phases");
  const double dppc = lipids * phases.ordered.dppc + (1 - lipids) * phases.disordered.dppc;
  if (std::fabs(dppc - membrane.dppc) > kOffTieLine)
    throw InputError(
        formatted("--composition: the membrane does not lie on the tie line; a mixture of these "
                  "phases has %.1f mol %% of DPPC, not %.1f",
                  100 * dppc, 100 * membrane.dppc));
  const double ordered = area(phases.ordered, lipids, celsius);
  return {lipids, ordered / (ordered + area(phases.disordered, 1 - lipids, celsius))};
}

RaftFractionEstimate estimated_raft_fraction(const LipidMixture& membrane, double celsius) {
  const PublishedMembrane& known = published(membrane);
  const double here = raft_fraction(membrane, known.phases, known.celsius).area;
  if (celsius == known.celsius)
    return {here, known.phases, formatted("tie line of %s at %.4g C", known.name, celsius)};
  const auto [low, high] = std::minmax(known.celsius, known.other_celsius);
  if (!(celsius >= low - kFarthest && celsius <= high + kFarthest))
    throw InputError(
        formatted("%.4g C is too far from the %.4g to %.4g C at which raft fractions of %s are "
                  "known; choose a temperature from %.4g to %.4g C",
                  celsius, low, high, known.name, low - kFarthest, high + kFarthest));
  const double share = (celsius - known.celsius) / (known.other_celsius - known.celsius);
  return {here + share * (known.other_area - here),
          {},
          formatted("%s %.1f %% at %.4g C (tie line) and %.1f %% at %.4g C (published)",
                    share >= 0 && share <= 1 ? "interpolated between" : "EXTRAPOLATED from",
                    100 * here, known.celsius, 100 * known.other_area, known.other_celsius)};
}

}  // namespace traceraft::observations
