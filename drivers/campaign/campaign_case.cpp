#include "drivers/campaign/campaign_case.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "backends/posix/own_files.hpp"
#include "drivers/campaign/hidden_case.hpp"
#include "drivers/explain/resumable_search.hpp"
#include "drivers/explain/search_file.hpp"
#include "drivers/input/json_file.hpp"
#include "drivers/output/program.hpp"
#include "drivers/output/status_line.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/random.hpp"
#include "kernel/core/stopwatch.hpp"
#include "verification/selection/search/rerun.hpp"
#include "verification/statistics/random_streams.hpp"

namespace traceraft::campaign {
namespace {

namespace fs = std::filesystem;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// Equal for a case wherever it is carried out: its name's hash by FNV-1a (Fowler, Noll, Vo), whose
// high bits are the good ones. A double holds it.
std::uint64_t seed_of(const CampaignPlan& plan, const CaseId& id) {
  std::uint64_t hash = 14695981039346656037ULL ^ plan.seed;
  for (const char ch : "case " + id.name())
    hash = (hash ^ static_cast<unsigned char>(ch)) * 1099511628211ULL;
  return hash >> 11;
}

// D of the truth over that of the model.
double diffusion_ratio_of(const CaseSettings& settings, std::uint64_t seed) {
  if (settings.diffusion_error > 0)
    return std::exp(settings.diffusion_error *
                    normal_random(seed, statistics::stream::diffusion, 1));
  return std::exp(0.4 * (uniform_random(seed, statistics::stream::diffusion, 0) - 0.5));
}

void draw(const fs::path& folder, const CampaignPlan& plan, const CaseSettings& settings,
          std::uint64_t seed) {
  const config::Configuration model(plan.model, {});
  selection::BlindRequest request;
  request.effects = settings.hidden;
  request.gap = settings.gap;
  request.noise = settings.noise;
  set_shared_noise(plan.noise, request);
  request.stated = settings.stated;
  request.snapshots = settings.snapshots;
  request.sizing_snapshots = CaseSettings().snapshots;
  request.points = plan.points;
  request.diffusion_ratio = diffusion_ratio_of(settings, seed);
  request.cells = truth_cells(plan.model);
  request.seed = seed;
  request.threads = 1;
  config::GivenValues given = plan.model;
  const auto cells = std::lround(settings.coarser * static_cast<double>(model.options().cells));
  given["cells"] = {std::to_string(cells), "campaign"};
  hide(folder, given, request);
}

// The gaps of the model that knows the truth; none if it cannot be advanced on the model's mesh.
assimilation::Gaps floor_of(const explain::ExplainSetup& setup, const HiddenTruth& truth) {
  try {
    return selection::gaps_of_model(setup.series, setup.request, truth.diffusion_ratio,
                                    truth.effects)
        .gap;
  } catch (const std::runtime_error& error) {
    text::say_error(std::string("no forecast by the true model: ") + error.what());
    return {};
  }
}

// The time (s) that the search took, in all processes that carried it on.
double seconds_of(const fs::path& explained) {
  const fs::path file = explained / "time.json";
  if (!fs::exists(file)) return 0;
  return input::from_json(file, [](const input::Json& json) { return json.at("seconds"); });
}

// One by another build, or that is damaged, is none.
void forget_if_unusable(const fs::path& explained, const explain::ExplainSetup& setup) {
  const auto forget = [&](const std::exception& why) {
    text::say("the search starts again: %s\n", why.what());
    for (const char* file : {"search.json", "time.json"}) fs::remove(explained / file);
  };
  try {
    (void)explain::SearchFile(explained, setup).load();
  } catch (const InputError& error) {
    forget(error);
  } catch (const DamagedFile& error) {
    forget(error);
  }
}

// Its steps are told to the case's log.
selection::Explanation search(const fs::path& explained, explain::ExplainSetup& setup) {
  forget_if_unusable(explained, setup);
  const double before = seconds_of(explained);
  const Stopwatch watch;
  setup.request.progress = [&](const std::string& step) {
    const double seconds = before + watch.seconds();
    input::write_json(explained / "time.json", {{"seconds", seconds}});
    text::say("%s  %s\n", output::clock_text(seconds), step);
    text::flush_output();
  };
  selection::Explanation found = explain::search_resumably(explained, setup);
  setup.request.progress("done");
  setup.request.progress = nullptr;
  return found;
}

void write_score(const CampaignFolder& folder, const CampaignGroup& group, const CaseId& id,
                 const selection::Explanation& found, const explain::ExplainSetup& setup) {
  const HiddenTruth truth = open_truth(folder.of(id));
  const std::string hidden = names_of(truth.effects);
  const explain::Verdict verdict = explain::verdict_of(found, setup);
  const auto strength = strength_error(truth, setup.configuration.units(), verdict);
  const auto heldout = [](const assimilation::Gaps& gap) {
    return gap.heldout > 0 ? input::Json(gap.heldout) : input::Json();
  };
  const input::Json score = {
      {"hidden", hidden},
      {"verdict", selection::word_for(verdict.finding)},
      {"effect", verdict.members.empty() ? "" : verdict.members.front()},
      {"class", verdict.members},
      {"outcome", word_for(outcome_of(group.aim, hidden, verdict))},
      {"p", input::number_or_null(verdict.p)},
      {"rounds", verdict.null_details.at("rounds")},
      {"heldout",
       {{"base", heldout(verdict.base_gap)},
        {"named", heldout(verdict.named_gap)},
        {"placebo", heldout(verdict.runner_up_gap)},
        {"floor", heldout(floor_of(setup, truth))}}},
      {"error", strength ? input::Json(strength->relative) : input::Json()},
      {"deviations", strength ? input::Json(strength->deviations) : input::Json()},
      {"seconds", seconds_of(folder.of(id) / "explain")},
      {"program", output::program_checksum()}};
  input::write_json(folder.score_of(id), score);
}

}  // namespace

void carry_out_case(const CampaignFolder& folder, const CampaignPlan& plan, const CaseId& id) {
  const CampaignGroup& group = campaign_groups().find(id.group);
  const fs::path path = folder.of(id);
  const std::uint64_t seed = seed_of(plan, id);
  const CaseSettings settings = settings_of(group, id.number, seed);
  if (!fs::exists(path / "model.toml")) draw(path, plan, settings, seed);

  explain::ExplainJob job;
  job.data = path / "data";
  job.model = path / "model.toml";
  job.threads = 1;
  job.replicates = plan.replicates;
  job.effects = plan.effects;
  job.diffusion_error = settings.diffusion_error;
  if (group.aim == Aim::unnamed)
    job.without = effects_like(open_truth(path).effects.front().effect);
  explain::ExplainSetup setup = explain::read_explain_job(job);
  posix::make_inner_folder(path / "explain");
  const selection::Explanation found = search(path / "explain", setup);
  write_score(folder, group, id, found, setup);
}

CaseScore read_score(const CampaignFolder& folder, const CaseId& id) {
  return input::from_json(folder.score_of(id), [&](const input::Json& json) {
    const auto number = [](const input::Json& value) {
      return value.is_null() ? kNothing : value.get<double>();
    };
    const input::Json& heldout = json.at("heldout");
    return CaseScore{id,
                     json.at("hidden"),
                     json.at("verdict"),
                     json.at("effect"),
                     outcome_of(json.at("outcome")),
                     number(json.at("error")),
                     number(json.at("deviations")),
                     number(json.at("p")),
                     number(heldout.at("base")),
                     number(heldout.at("named")),
                     number(heldout.at("placebo")),
                     number(heldout.at("floor")),
                     number(json.at("seconds")),
                     json.value("program", "")};
  });
}

}  // namespace traceraft::campaign
