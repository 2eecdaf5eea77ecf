// Power laws of coarsening: where they are looked for, what is found, and how it is drawn.
#pragma once

#include "verification/bench/ensemble.hpp"
#include "verification/studies/study.hpp"

namespace traceraft {

// The last stretch of times in which `holds` all the time.
Window window_where(const std::vector<double>& times,
                    const std::function<bool(std::size_t)>& holds);

// A quantity of an ensemble that is to follow t^theory.
struct Law {
  std::string ensemble, quantity;
  std::vector<double> Member::*values;
  double theory;
};

// An ensemble that has been run.
struct Ensemble {
  EnsembleRequest request;
  std::vector<Member> members;

  Ensemble(const Bench& bench, EnsembleRequest request);
  // At the common times, over all members.
  std::vector<double> mean(std::vector<double> Member::*values) const;
};

// The table of measured exponents, without rows.
Table exponents_table();
// Adds a row to it. Throws std::runtime_error if the window is too short to fit a law in.
Exponent measure_law(const Ensemble& ensemble, const Law& law, const Window& window, Origin origin,
                     Table& exponents);
// |b − theory| ≤ margin, with the interval as its uncertainty; `of`: what it is a power of.
Claim exponent_claim(const Law& law, const std::string& of, const Exponent& found, double margin);
// Theory lies in the interval.
Claim interval_claim(const Law& law, const std::string& of, const Exponent& found);

Points as_points(const std::vector<double>& times, const std::vector<double>& values);
// A straight line with the exponent b through the middle of the window.
ChartSeries law_line(const std::string& name, const Points& points, const Window& window, double b);
Chart coarsening_chart(const std::string& title, const std::string& y_label,
                       std::vector<ChartSeries> series);

// What the studies of coarsening have in common.
inline constexpr const char* kConstant = "constant:value=0.25";  // the mobility
// Widths of a boundary, in |Γ|/perimeter over ε, from which on boundaries are thin.
inline constexpr double kWidthsLate = 25;

struct Sizes {
  int cells;
  double epsilon;
  int members;
  Part part = {};  // of the time that all of them take
};

// 24 times per decade from t = 0.1 on.
EnsembleRequest ensemble_request(const std::string& mobility, double fraction, const Sizes& sizes,
                                 double t_end);

struct Findings {
  StudyReport report;
  Table exponents = exponents_table();
  Table cost{
      "cost",
      {"ensemble", "cells", "epsilon", "h/epsilon", "members", "t_end", "steps each", "wall_s"},
      {}};
};

// Runs it, and adds a row with its size and what it cost.
Ensemble measured_ensemble(const Bench& bench, const std::string& name,
                           const EnsembleRequest& request, Findings& findings);
// With the tables, a note on the intervals and `windows`, which says where laws are looked for.
StudyReport finished_report(Findings findings, const std::string& windows);

std::string at_time(double t);

}  // namespace traceraft
