#include <cstdio>

#include "drivers/commands.hpp"
#include "drivers/exit_codes.hpp"
#include "kernel/core/stopwatch.hpp"
#include "verification/studies.hpp"

namespace traceraft {
namespace {

void print_table(const StudyReport& report) {
  for (const std::string& column : report.columns) std::printf("  %12s", column.c_str());
  std::printf("\n");
  for (const auto& row : report.rows) {
    for (const double value : row) std::printf("  %12.5g", value);
    std::printf("\n");
  }
}

bool print_claims(const StudyReport& report) {
  bool all = true;
  std::printf("\n  %-44s %10s   %-18s %s\n", "claim", "measured", "expected", "verdict");
  for (const Claim& claim : report.claims) {
    std::printf("  %-44s %10.4g   %g to %-10g %s\n", claim.what.c_str(), claim.measured, claim.low,
                claim.high, claim.holds() ? "holds" : "FAILS");
    all = all && claim.holds();
  }
  return all;
}

}  // namespace

int verify_command(const VerifyRequest& request) {
  std::vector<StudyEntry> chosen;
  for (const std::string& name : request.studies) {
    if (name != "all") chosen.push_back(studies().find(name));
    for (const StudyEntry& study : studies())
      if (name == "all" && !study.timed) chosen.push_back(study);
  }
  bool all = true;
  for (const StudyEntry& study : chosen) {
    std::printf("%s: %s\n\n", study.name.c_str(), study.summary.c_str());
    const Stopwatch watch;
    const StudyReport report = study.run({request.quick});
    if (!report.skipped.empty()) {
      std::printf("  not measured: %s\n\n", report.skipped.c_str());
      continue;
    }
    print_table(report);
    all = print_claims(report) && all;
    std::printf("\n  %.1f s\n\n", watch.seconds());
  }
  return all ? kSuccess : kClaimFailed;
}

}  // namespace traceraft
