// One case of a campaign: drawn, explained and scored.
#pragma once

#include "drivers/campaign/campaign_folder.hpp"
#include "drivers/campaign/case_outcome.hpp"

namespace traceraft::campaign {

struct CaseScore {
  CaseId id;
  std::string hidden, verdict, effect;  // names joined by " + "; "" for none
  CaseOutcome outcome;
  // Errors of the strength of an effect that was named rightly: relative, and in standard
  // deviations. NaN where there is none.
  double error, deviations;
  double p;                            // of the most telling candidate, first round
  double base, named, placebo, floor;  // held-out gaps; floor: of the truth
  double seconds;
  std::string program = "";  // checksum of the build that explained it; "" if not known
};

// Does what the case still lacks and writes its score. Throws what drawing and explaining throw.
void carry_out_case(const CampaignFolder& folder, const CampaignPlan& plan, const CaseId& id);

CaseScore read_score(const CampaignFolder& folder, const CaseId& id);

}  // namespace traceraft::campaign
