// The folder of one run: who may write to it and what is where.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "backends/posix/folder_lock.hpp"
#include "drivers/config/configuration.hpp"
#include "kernel/core/communicator.hpp"

namespace traceraft::run {

struct RunFolder {
  std::filesystem::path path;
  std::unique_ptr<posix::FolderLock> lock;  // of the first rank

  std::filesystem::path config() const { return path / "config.toml"; }
  std::filesystem::path summary() const { return path / "summary.json"; }
  std::filesystem::path fields() const { return path / "fields"; }
  std::filesystem::path checkpoints() const { return path / "checkpoints"; }
  std::filesystem::path table(const std::string& name) const { return path / name; }
};

// The files that a run, and `report`, write into a folder, as own_files.hpp names them.
std::vector<std::string> files_of_a_run();
std::vector<std::string> files_of_a_report();

// runs/<name>-<first free number>.
std::string first_free_folder(const std::string& name);

// Throws InputError if a folder holds what explain, ensembles and the like write, or measurements.
void refuse_folder_of_others(const std::filesystem::path& path);

// The same, and if it holds what a run writes.
void refuse_files_of_a_run(const std::filesystem::path& path);
// The same, if it exists and before it is locked: no lock file is left where it is refused. Throws
// LockedError, too.
void refuse_before_lock(const std::filesystem::path& path);
// Throws InputError: another process has begun something there between choice and lock.
[[noreturn]] void refuse_begun(const std::filesystem::path& path);

// Throws InputError if a folder that is to be written to holds anything and none of `own`, the
// files by which the command knows its folders: what is there may be somebody's. Locks do not
// count.
void refuse_foreign_folder(const std::filesystem::path& path, const std::vector<std::string>& own);

// On every rank the folder that the first one has made or opened, or what it has thrown.
RunFolder shared_folder(const Communicator& ranks, const std::function<RunFolder()>& open);

// A folder for a new run, locked, holding its resolved configuration. An empty `out` means
// runs/<case>-<first free number>. Throws InputError if it holds anything already, LockedError if a
// run is going on there, IoError.
RunFolder create_run_folder(const std::string& out, const config::Configuration& configuration);

// The folder of an earlier run, locked. Throws InputError if there is none, LockedError, IoError.
RunFolder open_run_folder(const std::filesystem::path& path);

}  // namespace traceraft::run
