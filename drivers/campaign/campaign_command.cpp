#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "backends/posix/folder_lock.hpp"
#include "backends/posix/own_files.hpp"
#include "backends/posix/process.hpp"
#include "drivers/campaign/campaign_report.hpp"
#include "drivers/campaign/hidden_case.hpp"
#include "drivers/campaign/noise_flags.hpp"
#include "drivers/campaign/vesicle_flags.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/explain/explain_run.hpp"
#include "drivers/jobs/pending_jobs.hpp"
#include "drivers/output/text_table.hpp"
#include "drivers/run/run_folder.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::campaign {
namespace {

namespace fs = std::filesystem;

struct CampaignRequest {
  CampaignPlan plan;
  std::string out, only;
  std::vector<std::string> elsewhere;       // folders of campaigns
  int cases = 0;                            // of each group, if given
  std::vector<const CLI::Option*> planned;  // what a campaign that has begun does not change
  int jobs = 0;
  bool quiet = false;
};

CampaignPlan new_plan(const CampaignRequest& request) {
  CampaignPlan plan = request.plan;
  if (request.cases > 0) plan.cases = request.cases;
  if (plan.groups.empty()) plan.groups = campaign_groups().names();
  for (const std::string& group : plan.groups) (void)campaign_groups().find(group);
  add_small_vesicle(plan.model, "campaign");
  (void)config::Configuration(plan.model, {});
  check_shared_noise(plan.noise);
  return plan;
}

// The plan that the campaign began with, perhaps with more cases. `flag`: that names the folder.
CampaignPlan grown_plan(const CampaignRequest& request, const CampaignFolder& folder,
                        const std::string& flag) {
  CampaignPlan plan = folder.load();
  const bool asked = std::any_of(request.planned.begin(), request.planned.end(),
                                 [](const CLI::Option* option) { return option->count() > 0; });
  if (asked) {
    const CampaignPlan wanted = new_plan(request);
    if (wanted.groups != plan.groups || !same_but_for_cases(wanted, plan))
      throw InputError(flag + ": " + folder.path().string() +
                       " holds a campaign with another plan; choose another folder; to continue "
                       "it, leave out --groups, --seed and the other options of the plan");
  }
  plan.cases = std::max(plan.cases, request.cases);
  return plan;
}

CampaignFolder begun_elsewhere(const std::string& path) {
  CampaignFolder folder(path);
  if (!folder.started()) throw InputError("--elsewhere: " + path + " holds no campaign");
  return folder;
}

// The scores of campaigns with the same plan that were carried out elsewhere. A case that several
// of them have counts once, as in the first.
std::vector<CaseScore> scores_of(const std::vector<std::string>& folders,
                                 const CampaignPlan& plan) {
  std::vector<CaseScore> scores;
  std::set<std::string> counted;
  for (const std::string& path : folders) {
    const CampaignFolder folder = begun_elsewhere(path);
    if (!same_but_for_cases(plan, folder.load()))
      throw InputError("--elsewhere: the campaign in " + folder.path().string() +
                       " has another plan");
    for (CaseScore& score : read_cases(folder.cases()))
      if (counted.insert(score.id.name()).second) scores.push_back(std::move(score));
  }
  return scores;
}

int one_case(const CampaignFolder& folder, const std::string& name) {
  const CampaignPlan plan = folder.load();
  for (const CaseId& id : cases_of(plan))
    if (id.name() == name) {
      carry_out_case(folder, plan, id);
      return drivers::kSuccess;
    }
  throw InputError("--case: this campaign has no case '" + name + "'");
}

jobs::JobsEnd run_cases(const CampaignFolder& folder, const std::vector<CaseId>& left,
                        std::size_t before, int at_a_time, bool quiet) {
  if (!quiet && !left.empty())
    text::say("%zu cases, %d at a time; most take several minutes\nfolder %s\n", left.size(),
              at_a_time, folder.path());
  jobs::PendingJobs work;
  work.count = left.size();
  work.before = before;
  work.at_a_time = at_a_time;
  work.kind = "cases";
  work.folder = folder.path();
  work.quiet = quiet;
  work.run = [&](std::size_t k) {
    posix::make_inner_folder(folder.of(left[k]));
    return jobs::run_program(
        {"campaign", "--out", folder.path().string(), "--case", left[k].name()},
        folder.log_of(left[k]));
  };
  work.name = [&](std::size_t k) { return left[k].name(); };
  return jobs::run_pending_jobs(work);
}

void report(const CampaignFolder& folder, std::vector<CaseScore> scores,
            const std::vector<CaseFailure>& failures, bool quiet) {
  if (scores.empty() && failures.empty()) return;
  std::sort(scores.begin(), scores.end(),
            [](const CaseScore& a, const CaseScore& b) { return a.id.name() < b.id.name(); });
  write_campaign(folder, scores, failures);
  if (quiet) return;
  output::print_rows(output::table_rows(summary_of(scores, failures)));
  if (const bench::Table confusion = confusion_of(scores); !confusion.rows.empty()) {
    text::say("\n");
    output::print_rows(output::table_rows(confusion));
  }
  text::say("\nwritten: %s\n", (folder.path() / "campaign.md"));
}

std::string command_to_go_on(const CampaignFolder& folder, const CampaignRequest& request) {
  std::string command = "traceraft campaign --out " + text::in_shell(folder.path().string());
  for (const std::string& path : request.elsewhere)
    command += " --elsewhere " + text::in_shell(path);
  return command;
}

int run_campaign(const CampaignRequest& request) {
  const bool goes_on = !request.out.empty() && CampaignFolder(request.out).started();
  if (!request.only.empty()) {
    if (!goes_on) throw InputError("--case: --out must name an existing campaign");
    return one_case(CampaignFolder(request.out), request.only);
  }
  posix::catch_stop_signals();
  const CampaignFolder folder(request.out.empty() ? run::first_free_folder("campaign")
                                                  : request.out);
  const CampaignPlan plan =
      goes_on ? grown_plan(request, folder, "--out")
      : request.elsewhere.empty()
          ? new_plan(request)
          : grown_plan(request, begun_elsewhere(request.elsewhere[0]), "--elsewhere");
  std::vector<CaseScore> scores = scores_of(request.elsewhere, plan);
  if (!goes_on) run::refuse_foreign_folder(folder.path(), {});
  posix::make_inner_folder(folder.path() / "cases");
  const posix::FolderLock lock(folder.path());
  folder.save(plan);
  std::set<std::string> done;
  for (const CaseScore& score : scores) done.insert(score.id.name());
  std::vector<CaseId> cases, left;
  for (const CaseId& id : cases_of(plan))
    if (done.count(id.name()) == 0) cases.push_back(id);
  for (const CaseId& id : cases)
    if (!fs::exists(folder.score_of(id))) left.push_back(id);
  const jobs::JobsEnd end = run_cases(folder, left, cases.size() - left.size(),
                                      jobs::jobs_of(request.jobs, 1).at_a_time, request.quiet);
  std::vector<CaseFailure> failures;
  for (const jobs::JobFailure& failure : end.failures)
    failures.push_back({left[failure.job], failure.why});
  for (const CaseId& id : cases)
    if (fs::exists(folder.score_of(id))) scores.push_back(read_score(folder, id));
  report(folder, scores, failures, request.quiet);
  for (const CaseFailure& failure : failures)
    text::say_error(failure.id.name() + ": " + failure.why);
  if (end.stopped) {
    if (!request.quiet) text::say("continue with: %s\n", command_to_go_on(folder, request));
    return drivers::kInterrupted;
  }
  return failures.empty() ? drivers::kSuccess : drivers::kNumericalFailure;
}

drivers::Action define_campaign(CLI::App& app) {
  const auto request = std::make_shared<CampaignRequest>();
  app.add_option("--out", request->out,
                 "new folder, or folder of a campaign to continue; default: runs/campaign-<number>")
      ->type_name("DIR");
  app.add_option("--cases", request->cases,
                 "number of cases of each group; default: 11; a larger number extends a campaign")
      ->check(CLI::Range(1, kMostCases));
  app.add_option("--jobs", request->jobs, "cases at a time; default: one for each processor")
      ->check(CLI::Range(1, 1024));
  app.add_option("--elsewhere", request->elsewhere,
                 "folders of campaigns with the same plan, comma-separated; the cases in their "
                 "cases.csv are counted and not repeated; a new campaign takes over their plan")
      ->type_name("DIR,...")
      ->delimiter(',');
  app.add_option("--case", request->only, "carry out this case only");
  app.add_flag("--quiet", request->quiet, "print errors only");
  const std::size_t changing = app.get_options().size();
  app.add_option("--groups", request->plan.groups,
                 "groups of cases, comma-separated (listed below); default: all")
      ->type_name("GROUP,...")
      ->delimiter(',');
  app.add_option("--seed", request->plan.seed, "seed of all random numbers")
      ->check(config::between(0, config::kLargestSeed))
      ->capture_default_str();
  app.add_option("--points", request->plan.points, "number of points of each snapshot")
      ->check(CLI::Range(kFewestPoints, kMostPoints))
      ->capture_default_str();
  app.add_option("--replicates", request->plan.replicates,
                 "number of data sets with noise alone that give the p values of a search")
      ->check(CLI::Range(explain::kFewestReplicates, explain::kMostReplicates))
      ->capture_default_str();
  app.add_option("--most-effects", request->plan.effects,
                 "largest number of effects that a search may name")
      ->check(CLI::Range(1, explain::kMostNamedEffects))
      ->capture_default_str();
  add_noise_options(app, request->plan.noise);
  add_vesicle_options(app, request->plan.model);
  const auto all = std::as_const(app).get_options();
  request->planned.assign(all.begin() + static_cast<std::ptrdiff_t>(changing), all.end());
  std::string groups = "Groups:\n";
  for (const CampaignGroup& group : campaign_groups())
    groups += "  " + group.name + std::string(16 - group.name.size(), ' ') + group.summary + "\n";
  app.footer(groups +
             "Example: traceraft campaign --groups naming,null --cases 22 --out runs/campaign");
  return [request] { return run_campaign(*request); };
}

}  // namespace

drivers::Command campaign_command() {
  return {"campaign", "hide effects in many cases and count how often explain finds them",
          drivers::Ranks::one, define_campaign};
}

}  // namespace traceraft::campaign
