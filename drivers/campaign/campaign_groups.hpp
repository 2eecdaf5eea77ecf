// The cases that a campaign puts to `explain`: groups of blind cases that differ in one respect.
#pragma once

#include <string>
#include <vector>

#include "kernel/core/named_list.hpp"

namespace traceraft::campaign {

struct CaseSettings {
  std::vector<std::string> hidden;  // effects
  double gap = 0.06;                // change of c by each from one snapshot to the next, of eight
  double noise = 0.1;               // standard deviation, in units of that of c
  double stated = 0;                // what the data state of it, over what it is; 0: nothing
  int snapshots = 8;                // effects are as strong as between eight
  double diffusion_error = 0;       // of the model's D, that the search is told; 0: nothing
  double coarser = 1;               // cells of the model's mesh, over what its interface needs
};

// The verdict that a case has to have.
enum class Aim { name, nothing, unnamed };

struct CampaignGroup {
  std::string name;
  std::string summary;
  Aim aim;
  CaseSettings common;
  int effects = 1;  // that are hidden besides, one after the other of all that can be
};

const NamedList<CampaignGroup>& campaign_groups();

// An effect and those that data may not tell from it.
std::vector<std::string> effects_like(const std::string& effect);

// The settings of case `number` of a group; `seed` decides what chance does.
CaseSettings settings_of(const CampaignGroup& group, int number, std::uint64_t seed);

}  // namespace traceraft::campaign
