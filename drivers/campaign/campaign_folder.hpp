// The folder of a campaign: its plan, and a folder per case.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/campaign/campaign_groups.hpp"
#include "drivers/campaign/shared_noise.hpp"
#include "drivers/config/configuration.hpp"

namespace traceraft::campaign {

inline constexpr int kMostCases = 999, kFewestPoints = 100, kMostPoints = 1000000;

struct CampaignPlan {
  std::vector<std::string> groups;
  int cases = 11;  // of each group
  std::uint64_t seed = 1;
  int points = 4000, replicates = 199;
  int effects = 3;  // that a search may name
  config::GivenValues model;
  SharedNoise noise = {};
};

struct CaseId {
  std::string group;
  int number;

  std::string name() const;  // "naming-007"
  static CaseId of(const std::string& name);
};

class CampaignFolder {
 public:
  explicit CampaignFolder(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }
  bool started() const { return std::filesystem::exists(plan_file()); }
  void save(const CampaignPlan& plan) const;
  CampaignPlan load() const;  // throws IoError if it is damaged
  std::filesystem::path cases() const { return path_ / "cases.csv"; }

  std::filesystem::path of(const CaseId& id) const { return path_ / "cases" / id.name(); }
  std::filesystem::path score_of(const CaseId& id) const { return of(id) / "score.json"; }
  std::filesystem::path log_of(const CaseId& id) const { return of(id).string() + ".log"; }

 private:
  std::filesystem::path plan_file() const { return path_ / "plan.json"; }
  std::filesystem::path path_;
};

// Do they differ in their groups and in how many cases there are of each, at most?
bool same_but_for_cases(const CampaignPlan& a, const CampaignPlan& b);

std::vector<CaseId> cases_of(const CampaignPlan& plan);  // groups taking turns

}  // namespace traceraft::campaign
