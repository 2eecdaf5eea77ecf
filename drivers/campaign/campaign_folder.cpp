#include "drivers/campaign/campaign_folder.hpp"

#include "drivers/output/json_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft {

namespace {

Json plan_json(const CampaignPlan& plan) {
  Json model = Json::object();
  for (const auto& [name, value] : plan.model) model[name] = value.text;
  return {{"groups", plan.groups},  {"cases", plan.cases}, {"seed", plan.seed},
          {"points", plan.points},  {"model", model},      {"replicates", plan.replicates},
          {"effects", plan.effects}};
}

}  // namespace

void CampaignFolder::save(const CampaignPlan& plan) const {
  write_durably(plan_file(), plan_json(plan).dump(2) + "\n");
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

CaseId CaseId::of(const std::string& name) {
  const std::size_t dash = name.rfind('-');
  const std::string number = dash == std::string::npos ? "" : name.substr(dash + 1);
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos ||
      number.size() > 6)
    throw InputError("'" + name + "' is no case of a campaign");
  return {name.substr(0, dash), std::stoi(number)};
}

bool same_but_for_cases(const CampaignPlan& a, const CampaignPlan& b) {
  CampaignPlan like_a = b;
  like_a.groups = a.groups;
  like_a.cases = a.cases;
  return plan_json(a) == plan_json(like_a);
}

std::vector<CaseId> cases_of(const CampaignPlan& plan) {
  std::vector<CaseId> cases;
  for (int number = 0; number < plan.cases; ++number)
    for (const std::string& group : plan.groups) cases.push_back({group, number});
  return cases;
}

}  // namespace traceraft
