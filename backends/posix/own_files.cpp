#include "backends/posix/own_files.hpp"

#include <fnmatch.h>

#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::posix {
namespace {

namespace fs = std::filesystem;

bool matches(const fs::path& path, const std::string& name) {
  return ::fnmatch(name.c_str(), path.c_str(), FNM_PATHNAME) == 0;
}

// Does a name lead through this folder?
bool leads_through(const fs::path& path, const std::string& name) {
  for (fs::path parent = fs::path(name).parent_path(); !parent.empty();
       parent = parent.parent_path())
    if (matches(path, parent.string())) return true;
  return false;
}

bool is_own(const fs::directory_entry& entry, const fs::path& below,
            const std::vector<std::string>& names) {
  const fs::file_status status = entry.symlink_status();
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    if (fs::is_directory(status)) return leads_through(below, name);
    return fs::is_regular_file(status) &&
           (matches(below, name) ||
            (matches(below.filename(), kTemporaryFiles) &&
             (!below.has_parent_path() || leads_through(below.parent_path(), name))));
  });
}

}  // namespace

fs::path first_foreign(const fs::path& folder, const std::vector<std::string>& names) {
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path below = entry.path().lexically_relative(folder);
    if (!is_own(entry, below, names)) return below;
  }
  return {};
}

void remove_own_folder(const fs::path& folder, const std::vector<std::string>& names) {
  if (fs::is_symlink(fs::symlink_status(folder)))
    throw IoError(folder.string() + " is a link; it is not deleted");
  if (const fs::path foreign = first_foreign(folder, names); !foreign.empty())
    throw IoError(folder.string() + " is not deleted: it holds " + foreign.string() +
                  ", which is not the program's; move that away");
  std::vector<fs::path> all;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) all.push_back(entry.path());
  // The content of a folder comes after it. A folder that is not empty by now stays, with an error.
  for (auto path = all.rbegin(); path != all.rend(); ++path) fs::remove(*path);
  fs::remove(folder);
}

void remove_file(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(path, error)) || (fs::remove(path, error), error))
    throw IoError("cannot replace " + path.string() +
                  (error ? ": " + error.message() : ", which is a folder"));
}

void make_inner_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  const bool link = fs::is_symlink(fs::symlink_status(path));
  if (!link && (fs::is_directory(path) || fs::create_directory(path, error))) return;
  throw IoError(path.string() + (link    ? " is a link; the program writes through none"
                                 : error ? ": " + error.message()
                                         : " is no folder"));
}

bool is_temporary_file(const fs::path& path) {
  return matches(path.filename(), kTemporaryFiles) && fs::is_regular_file(fs::symlink_status(path));
}

void remove_temporary_files(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_temporary_file(entry.path())) fs::remove(entry.path());
}

}  // namespace traceraft::posix
