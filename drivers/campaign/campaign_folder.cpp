#include "drivers/campaign/campaign_folder.hpp"

#include "drivers/output/json_file.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {

void CampaignFolder::save(const CampaignPlan& plan) const {
  Json model = Json::object();
  for (const auto& [name, value] : plan.model) model[name] = value.text;
  const Json json = {{"groups", plan.groups},  {"cases", plan.cases},
                     {"seed", plan.seed},      {"points", plan.points},
                     {"model", model},         {"replicates", plan.replicates},
                     {"effects", plan.effects}};
  write_durably(plan_file(), json.dump(2) + "\n");
}

CampaignPlan CampaignFolder::load() const {
  return from_json(plan_file(), [this](const Json& json) {
    CampaignPlan plan{json.at("groups"),
                      json.at("cases"),
                      json.at("seed"),
                      json.at("points"),
                      json.at("replicates"),
                      json.at("effects"),
                      {}};
    for (const auto& [name, text] : json.at("model").items())
      plan.model[name] = {text, plan_file().string() + ": " + name};
    return plan;
  });
}

std::string CaseId::name() const {
  return formatted("%s-%03d", group.c_str(), number);
}

std::vector<CaseId> cases_of(const CampaignPlan& plan) {
  std::vector<CaseId> cases;
  for (int number = 0; number < plan.cases; ++number)
    for (const std::string& group : plan.groups) cases.push_back({group, number});
  return cases;
}

}  // namespace traceraft
