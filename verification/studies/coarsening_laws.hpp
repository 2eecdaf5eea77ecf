// Power laws of coarsening: where they are looked for, what is found, and how it is drawn.
#pragma once

#include "verification/bench/ensemble.hpp"
#include "verification/studies/study.hpp"

namespace traceraft::studies {

// The last stretch of times in which `holds` all the time.
statistics::Window window_where(const std::vector<double>& times,
                                const std::function<bool(std::size_t)>& holds);

// A quantity of an ensemble that is to follow t^theory.
struct Law {
  std::string ensemble, quantity;
  std::vector<double> bench::Member::*values;
  double theory;
};

// An ensemble that has been run.
struct Ensemble {
  bench::EnsembleRequest request;
  std::vector<bench::Member> members;

  Ensemble(const bench::Bench& bench, bench::EnsembleRequest request);
  Ensemble(bench::EnsembleRequest request, std::vector<bench::Member> members);
  // At the common times, over all members.
  std::vector<double> mean(std::vector<double> bench::Member::*values) const;
};

// The table of measured exponents, without rows.
bench::Table exponents_table();
// Adds a row to it. Throws std::runtime_error if the window is too short to fit a law in.
bench::Exponent measure_law(const Ensemble& ensemble, const Law& law,
                            const statistics::Window& window, bench::Origin origin,
                            bench::Table& exponents);
// |b − theory| ≤ margin, with the interval as its uncertainty; `of`: what it is a power of.
Claim exponent_claim(const Law& law, const std::string& of, const bench::Exponent& found,
                     double margin);
// Theory lies in the interval.
Claim interval_claim(const Law& law, const std::string& of, const bench::Exponent& found);

statistics::Points as_points(const std::vector<double>& times, const std::vector<double>& values);
// A straight line with the exponent b through the middle of the window.
bench::ChartSeries law_line(const std::string& name, const statistics::Points& points,
                            const statistics::Window& window, double b);
bench::Chart coarsening_chart(const std::string& title, const std::string& y_label,
                              std::vector<bench::ChartSeries> series);

// The constants that the studies of coarsening have in common.
inline constexpr const char* kConstant = "constant:value=0.25";  // the mobility
// Widths of a boundary, in |Γ|/perimeter over ε, from which on boundaries are thin.
inline constexpr double kWidthsLate = 25;

struct Sizes {
  int cells;
  double epsilon;
  int members;
  bench::Part part = {};  // of the time that all of them take
};

// 24 times per decade.
std::vector<double> times_between(double begin, double end);
// At times from t = 0.1 on.
bench::EnsembleRequest ensemble_request(const std::string& mobility, double fraction,
                                        const Sizes& sizes, double t_end);

struct Findings {
  StudyReport report;
  bench::Table exponents = exponents_table();
  bench::Table cost{
      "cost",
      {"ensemble", "cells", "epsilon", "h/epsilon", "members", "t_end", "steps each", "wall_s"},
      {}};
};

// Runs it, and adds a row with its size and what it cost.
Ensemble measured_ensemble(const bench::Bench& bench, const std::string& name,
                           const bench::EnsembleRequest& request, Findings& findings);
// The report with the tables, a note on the intervals and `windows`, which says where laws are
// looked for.
StudyReport finished_report(Findings findings, const std::string& windows);

std::string at_time(double t);

}  // namespace traceraft::studies
