// What the cases of a campaign add up to.
#pragma once

#include <filesystem>
#include <vector>

#include "drivers/campaign/campaign_case.hpp"
#include "verification/study.hpp"

namespace traceraft {

// A row per group: how many were right, and how well parameters and gaps came out.
Table summary_of(const std::vector<CaseScore>& scores);
// Hidden against found, over all groups in which something is hidden and looked for.
Table confusion_of(const std::vector<CaseScore>& scores);

// cases.csv, summary.csv, confusion.csv and campaign.md. Throws IoError.
void write_campaign(const std::filesystem::path& folder, const std::vector<CaseScore>& scores);

}  // namespace traceraft
