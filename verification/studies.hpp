// The list of verification studies, each a claim that is measured.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "kernel/core/named_list.hpp"

namespace traceraft {

// One measured claim: `measured` must lie in [low, high].
struct Claim {
  std::string what;
  double measured;
  double low, high;
  bool holds() const { return measured >= low && measured <= high; }  // false for NaN
};

struct StudyReport {
  std::vector<std::string> columns;  // of the table behind the claims
  std::vector<std::vector<double>> rows;
  std::vector<Claim> claims;
  std::string skipped = {};  // why this build cannot measure it
};

struct StudyRequest {
  bool quick = false;  // coarser and shorter, for every day
};

struct StudyEntry {
  std::string name;
  std::string summary;
  std::function<StudyReport(const StudyRequest&)> run;
  bool timed = false;  // claims about speed: for people to run, never part of the tests
};

StudyEntry mesh_convergence_study();
StudyEntry time_order_study();
StudyEntry integrator_agreement_study();
StudyEntry solver_iterations_study();
StudyEntry teko_iterations_study();
StudyEntry operation_cost_study();
StudyEntry step_cost_study();

const NamedList<StudyEntry>& studies();

}  // namespace traceraft
