// The report of a campaign: what its cases add up to.
#pragma once

#include <filesystem>
#include <vector>

#include "drivers/campaign/campaign_case.hpp"
#include "verification/bench/figures.hpp"

namespace traceraft::campaign {

// A case that came to no verdict.
struct CaseFailure {
  CaseId id;
  std::string why;
};

// A row per group: how many were right, and how well parameters and gaps came out.
bench::Table summary_of(const std::vector<CaseScore>& scores,
                        const std::vector<CaseFailure>& failures = {});
// Hidden against found, over all groups in which something is hidden and looked for.
bench::Table confusion_of(const std::vector<CaseScore>& scores);

// cases.csv, summary.csv, confusion.csv and campaign.md. Throws IoError.
void write_campaign(const CampaignFolder& folder, const std::vector<CaseScore>& scores,
                    const std::vector<CaseFailure>& failures = {});

// The scores in cases.csv. Throws InputError naming the line of what cannot be read.
std::vector<CaseScore> read_cases(const std::filesystem::path& csv);

}  // namespace traceraft::campaign
