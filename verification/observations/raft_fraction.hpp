// How much of a vesicle is raft, from what its membrane is made of: the lever rule on a phase
// diagram, and areas per lipid (Zhiliakov et al., BBA Biomembranes 1863 (2021) 183446).
#pragma once

#include <optional>
#include <string>

namespace traceraft::observations {

// Mole fractions; their sum is 1.
struct LipidMixture {
  double dopc, dppc, cholesterol;
};

// "3:1:20" (or "3:1:20%"): three parts of DOPC to one of DPPC, with 20 mol % of cholesterol. Throws
// InputError that starts with `context`.
LipidMixture membrane_mixture(const std::string& context, const std::string& text);
bool same_membrane(const std::string& a, const std::string& b);
// "22:43:35": mole percent of each, which add up to 100.
LipidMixture phase_mixture(const std::string& context, const std::string& text);

// The ends of a tie line: what the liquid-ordered phase (the rafts) and the liquid-disordered one
// are made of.
struct CoexistingPhases {
  LipidMixture ordered, disordered;
};

struct RaftFraction {
  double lipids;  // share of all lipids that are in the ordered phase
  double area;    // share of the area that it covers
};

// Throws InputError if the membrane does not lie between the two phases.
RaftFraction raft_fraction(const LipidMixture& membrane, const CoexistingPhases& phases,
                           double celsius);

// Å² per lipid with its share of cholesterol, x the mole fraction of cholesterol.
double area_of_dopc(double x, double celsius);
double area_of_dppc(double x, double celsius);

// From what is published of a membrane: a tie line at one temperature, and the raft fraction at
// another; linear in the temperature.
struct RaftFractionEstimate {
  double area;
  std::optional<CoexistingPhases> phases;  // at the temperature of the tie line
  std::string how;                         // a sentence
};
// Throws InputError for a membrane or a temperature of which nothing is published.
RaftFractionEstimate estimated_raft_fraction(const LipidMixture& membrane, double celsius);

}  // namespace traceraft::observations
