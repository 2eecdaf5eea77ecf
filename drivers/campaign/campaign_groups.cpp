#include "drivers/campaign/campaign_groups.hpp"

#include <algorithm>

#include "kernel/core/random.hpp"
#include "kernel/effects/effects.hpp"
#include "verification/selection/blind/effect_size.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::campaign {
namespace {

CaseSettings with(const std::function<void(CaseSettings&)>& change) {
  CaseSettings settings;
  change(settings);
  return settings;
}

// Flow has a group of its own, so that the cases of the others stay what they were.
constexpr char kFlow[] = "flow", kBrownianFlow[] = "brownian-flow";

std::vector<std::string> effects_in_turn() {
  std::vector<std::string> all = selection::effects_to_hide();
  for (const char* own : {kFlow, kBrownianFlow})
    all.erase(std::remove(all.begin(), all.end(), own), all.end());
  return all;
}

}  // namespace

std::vector<std::string> effects_like(const std::string& effect) {
  std::vector<std::string> result{effect};
  for (const std::string& other : effects::effects().names()) {
    const auto names = [](const std::string& a, const std::string& b) {
      const auto& confused = effects::effects().find(a).confused_with;
      return std::find(confused.begin(), confused.end(), b) != confused.end();
    };
    if (names(effect, other) || names(other, effect)) result.push_back(other);
  }
  return result;
}

const NamedList<CampaignGroup>& campaign_groups() {
  static const NamedList<CampaignGroup> list(
      "group", {{"naming", "one effect, 10 % noise, 8 snapshots", Aim::name, {}, 1},
                {"naming-weak", "one effect, half as strong", Aim::name,
                 with([](CaseSettings& s) { s.gap = 0.03; }), 1},
                {"naming-strong", "one effect, twice as strong", Aim::name,
                 with([](CaseSettings& s) { s.gap = 0.12; }), 1},
                {"naming-noisy", "one effect, 20 % noise", Aim::name,
                 with([](CaseSettings& s) { s.noise = 0.2; }), 1},
                {"naming-short", "one effect, as strong as in naming, but only 3 snapshots",
                 Aim::name, with([](CaseSettings& s) { s.snapshots = 3; }), 1},
                {"measured-d", "one effect; the model's D is known to 5 %", Aim::name,
                 with([](CaseSettings& s) { s.diffusion_error = 0.05; }), 1},
                {"two", "two effects at once", Aim::name, {}, 2},
                {"left-out",
                 "one effect; explain does not search for it or for effects like it",
                 Aim::unnamed,
                 {},
                 1},
                {"stated-half", "one effect; every second snapshot states half of its true noise",
                 Aim::name, with([](CaseSettings& s) { s.stated = 0.5; }), 1},
                {"stated-double", "one effect; every second snapshot states twice its true noise",
                 Aim::name, with([](CaseSettings& s) { s.stated = 2; }), 1},
                {"flow", "flow of the membrane, driven by line tension", Aim::name,
                 with([](CaseSettings& s) { s.hidden = {kFlow}; }), 0},
                {"brownian-flow", "flow of the membrane, driven by thermal forces", Aim::name,
                 with([](CaseSettings& s) { s.hidden = {kBrownianFlow}; }), 0},
                {"null", "nothing hidden, 10 % noise", Aim::nothing, {}, 0},
                {"null-quiet", "nothing hidden, 5 % noise", Aim::nothing,
                 with([](CaseSettings& s) { s.noise = 0.05; }), 0},
                {"null-noisy", "nothing hidden, 20 % noise", Aim::nothing,
                 with([](CaseSettings& s) { s.noise = 0.2; }), 0},
                {"coarse", "nothing hidden; the model's mesh is too coarse", Aim::nothing,
                 with([](CaseSettings& s) { s.coarser = 0.67; }), 0}});
  return list;
}

CaseSettings settings_of(const CampaignGroup& group, int number, std::uint64_t seed) {
  CaseSettings settings = group.common;
  const std::vector<std::string> all = effects_in_turn();
  const std::size_t first = static_cast<std::size_t>(number) % all.size();
  if (group.effects > 0) settings.hidden.push_back(all[first]);
  if (group.effects > 1) {
    const double u = uniform_random(seed, statistics::stream::second_effect, 0);
    const auto further = static_cast<std::size_t>(u * static_cast<double>(all.size() - 1));
    settings.hidden.push_back(all[(first + 1 + further) % all.size()]);
  }
  return settings;
}

}  // namespace traceraft::campaign
