#include "drivers/run/run_folder.hpp"

#include <algorithm>
#include <optional>

#include "backends/posix/durable_file.hpp"
#include "backends/posix/own_files.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::run {
namespace {

namespace fs = std::filesystem;

void create_sub_folders(const RunFolder& folder) {
  posix::make_inner_folder(folder.fields());
  posix::make_inner_folder(folder.checkpoints());
}

// Is it the folder of an ensemble, say, or another set of runs with folders of their own?
bool holds_runs(const fs::path& path) {
  return fs::exists(path / "runs") || fs::exists(path / "plan.json");
}

}  // namespace

std::vector<std::string> files_of_a_report() {
  return {"report.html", "report-charts/*.gp", "report-charts/*.svg", "report-charts/*.log"};
}

std::vector<std::string> files_of_a_run() {
  std::vector<std::string> names = files_of_a_report();
  names.insert(names.end(), {posix::kLockFile, "config.toml", "series.csv", "observables.csv",
                             "rafts.csv", "view.png", "fields.pvd", "summary.json",
                             "fields/field-????*.vtu", "fields/field-????*.pvtu",
                             "fields/view-????*.png", "checkpoints/step-??????????.ckpt"});
  return names;
}

std::string first_free_folder(const std::string& name) {
  for (int number = 1;; ++number) {
    const std::string candidate = "runs/" + name + "-" + std::to_string(number);
    if (!fs::exists(candidate)) return candidate;
  }
}

void refuse_files_of_a_run(const fs::path& path) {
  const RunFolder folder{path, nullptr};
  for (const fs::path& ours :
       {folder.config(), folder.summary(), folder.fields(), folder.checkpoints(),
        folder.table("view.png"), folder.table("fields.pvd"), folder.table("series.csv"),
        folder.table("observables.csv"), folder.table("rafts.csv")})
    if (fs::exists(fs::symlink_status(ours)))
      throw InputError("--out: " + path.string() + " already holds " + ours.filename().string() +
                       (holds_runs(path) ? std::string(" of a set of runs")
                                         : "; continue it with: traceraft resume " +
                                               text::in_shell(path.string())) +
                       "; choose another folder");
  refuse_folder_of_others(path);
  refuse_foreign_folder(path, {});
}

void refuse_before_lock(const fs::path& path) {
  if (!fs::is_directory(path)) return;
  std::optional<posix::FolderLock> lock;
  if (fs::exists(path / posix::kLockFile)) lock.emplace(path);
  refuse_files_of_a_run(path);
}

void refuse_folder_of_others(const fs::path& path) {
  for (const char* others : {"dataset.toml", "measurements.csv", "truth.json", "search.json",
                             "series.json", "verdict.json", "calibration-model.toml",
                             "comparison.json", "campaign.md", "plan.json", "runs"})
    if (fs::exists(path / others))
      throw InputError("--out: " + path.string() + " holds " + others +
                       " of another command; choose another folder");
}

void refuse_begun(const fs::path& path) {
  throw InputError("another process has just started to work in " + path.string() +
                   "; give the command again, or choose a folder with --out");
}

void refuse_foreign_folder(const fs::path& path, const std::vector<std::string>& own) {
  if (!fs::exists(path)) return;
  if (!fs::is_directory(path)) throw InputError("--out: " + path.string() + " is not a folder");
  if (std::any_of(own.begin(), own.end(),
                  [&](const std::string& name) { return fs::exists(path / name); }))
    return;
  for (const auto& entry : fs::directory_iterator(path))
    if (entry.path().filename() != posix::kLockFile && !posix::is_temporary_file(entry.path()))
      throw InputError("--out: " + path.string() + " holds " + entry.path().filename().string() +
                       ", which this command did not write; choose another folder");
}

RunFolder shared_folder(const Communicator& ranks, const std::function<RunFolder()>& open) {
  // The outcome on the first rank, a path or what is wrong, after a letter for its kind.
  RunFolder folder;
  Lists<char> message;
  if (ranks.root()) {
    std::string text;
    try {
      folder = open();
      text = "p" + folder.path.string();
    } catch (const InputError& error) {
      text = std::string("i") + error.what();
    } catch (const posix::LockedError& error) {
      text = std::string("l") + error.what();
    } catch (const IoError& error) {
      text = std::string("o") + error.what();
    }
    message.assign(static_cast<std::size_t>(ranks.size()), {text.begin(), text.end()});
  }
  const std::vector<char> received = scatter(ranks, message);
  const std::string text(received.begin() + 1, received.end());
  if (received[0] == 'i') throw InputError(text);
  if (received[0] == 'l') throw posix::LockedError(text);
  if (received[0] == 'o') throw IoError(text);
  folder.path = text;
  return folder;
}

RunFolder create_run_folder(const std::string& out, const config::Configuration& configuration) {
  RunFolder folder;
  folder.path = out.empty() ? first_free_folder(configuration.options().case_name) : out;
  try {
    if (fs::exists(folder.path) && !fs::is_directory(folder.path))
      throw InputError("--out: " + folder.path.string() + " is a file");
    fs::create_directories(folder.path);
    folder.lock = std::make_unique<posix::FolderLock>(folder.path);
    refuse_files_of_a_run(folder.path);
    posix::remove_temporary_files(folder.path);
    // First what makes it a run that can be resumed.
    posix::write_durably(folder.config(), config::config_text(configuration));
    create_sub_folders(folder);
  } catch (const fs::filesystem_error& error) {
    throw IoError(std::string("--out: ") + error.what());
  }
  return folder;
}

RunFolder open_run_folder(const fs::path& path) {
  RunFolder folder;
  folder.path = path;
  if (!fs::is_directory(path)) throw InputError(path.string() + " is not a folder");
  if (!fs::exists(folder.config()))
    throw InputError(path.string() + " holds no run: there is no config.toml");
  if (holds_runs(path))
    throw InputError(path.string() +
                     " holds a set of runs; to continue it, repeat its command with --out " +
                     text::in_shell(path.string()));
  folder.lock = std::make_unique<posix::FolderLock>(path);
  create_sub_folders(folder);
  for (const fs::path& own : {folder.path, folder.fields(), folder.checkpoints()})
    posix::remove_temporary_files(own);
  return folder;
}

}  // namespace traceraft::run
