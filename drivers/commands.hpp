// One function per subcommand; each returns an exit code and throws InputError, IoError or
// LockedError.
#pragma once

#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"

namespace traceraft {

struct RunRequest {
  GivenValues flags;
  std::string config_file;  // "" for none
  std::string out;          // "" for the first free runs/<case>-N
  bool validate = false;    // stop after checking everything
  bool quiet = false;
};
int run_command(const RunRequest& request);

struct ResumeRequest {
  std::string folder;
  GivenValues flags;  // options that do not change the numbers
  bool quiet = false;
};
int resume_command(const ResumeRequest& request);

struct CompareRequest {
  GivenValues flags;
  std::string config_file;
  std::string out;                             // "" for the first free runs/compare-<case>-N
  std::string references = "runs/references";  // where reference solutions are kept
  // Comma-separated; "": what the comparison in `out` has, or defaults.
  std::string integrators, linear_solvers, tolerances, ranks;
  // 0 or, for the time limit, negative: likewise.
  int repeat = 0;
  double time_limit = -1, target_error = 0, reference_tolerance = 0;
  bool quiet = false;
};
int compare_command(const CompareRequest& request);

struct VerifyRequest {
  std::vector<std::string> studies;  // names, "all", or "list" alone
  bool quick = false, quiet = false;
  std::string integrator, linear_solver;  // "": each study's choice, or all where it compares
  int threads = 0;                        // 0: one for each processor
  std::string out;                        // "" for the first free runs/verify-N
  std::string document;                   // Markdown file to write; "" for none
};
int verify_command(const VerifyRequest& request);

struct FractionRequest {
  std::string composition;  // DOPC : DPPC : mol % of cholesterol
  double celsius = 20;
  std::string ordered, disordered;  // mol % of the two phases; "": from what is published
};
int fraction_command(const FractionRequest& request);

int list_command();

}  // namespace traceraft
