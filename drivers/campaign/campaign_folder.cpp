#include "drivers/campaign/campaign_folder.hpp"

#include <map>

#include "drivers/explain/explain_run.hpp"
#include "drivers/input/json_members.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::campaign {

template <class Members>
void describe(Members& members, SharedNoise& noise) {
  members("share", noise.share, input::WithinRange{0, 1});
  members("correlation", noise.length, input::WithinRange{0, kLongestDrawn});
  members("shape", noise.shape, input::OneOf{"shape", shared_noise_shapes()});
}

namespace {

// The plan as it stands in the file, with the texts of the model's options.
struct StoredPlan {
  CampaignPlan plan;
  std::map<std::string, std::string> model;
};

template <class Members>
void describe(Members& members, StoredPlan& stored) {
  CampaignPlan& plan = stored.plan;
  members("groups", plan.groups, input::Distinct{input::OneOf{"group", campaign_groups().names()}});
  members("cases", plan.cases, input::WithinRange{1, kMostCases});
  members("seed", plan.seed, input::WithinRange{0, config::kLargestSeed});
  members("points", plan.points, input::WithinRange{kFewestPoints, kMostPoints});
  members("model", stored.model, input::AnyText{});
  members("replicates", plan.replicates,
          input::WithinRange{explain::kFewestReplicates, explain::kMostReplicates});
  members("effects", plan.effects, input::WithinRange{1, explain::kMostNamedEffects});
  members.later("noise", plan.noise, input::AsDescribed{});
}

input::Json plan_json(const CampaignPlan& plan) {
  StoredPlan stored{plan, {}};
  for (const auto& [name, value] : plan.model) stored.model[name] = value.text;
  return input::object_of(stored);
}

}  // namespace

void CampaignFolder::save(const CampaignPlan& plan) const {
  input::write_json(plan_file(), plan_json(plan));
}

CampaignPlan CampaignFolder::load() const {
  StoredPlan stored = input::read_object<StoredPlan>(plan_file());
  for (const auto& [name, text] : stored.model) {
    const std::string where = plan_file().string() + ": model." + name;
    input::check_value(where, name, input::OneOf{"option", config::run_option_names()});
    stored.plan.model[name] = {text, where};
  }
  (void)config::Configuration(stored.plan.model, {});
  return stored.plan;
}

std::string CaseId::name() const {
  return formatted("%s-%03d", group.c_str(), number);
}

CaseId CaseId::of(const std::string& name) {
  const std::size_t dash = name.rfind('-');
  const std::string number = dash == std::string::npos ? "" : name.substr(dash + 1);
  if (number.empty() || number.find_first_not_of("0123456789") != std::string::npos ||
      number.size() > 6)
    throw InputError("'" + name + "' is not a case of a campaign");
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

}  // namespace traceraft::campaign
