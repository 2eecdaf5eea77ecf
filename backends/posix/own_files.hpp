// Deleting what the program itself has made, and nothing else.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace traceraft::posix {

// The first thing below `folder` that is none of the files of these names, "" if there is nothing
// else. Names are relative to it and may hold * and ? (fnmatch, which match no /). Folders that
// names lead to are no others; links and special files always are.
std::filesystem::path first_foreign(const std::filesystem::path& folder,
                                    const std::vector<std::string>& names);

// Deletes `folder` with the files of these names in it. Throws IoError, and deletes nothing, if it
// is a link or holds anything else.
void remove_own_folder(const std::filesystem::path& folder, const std::vector<std::string>& names);

// Deletes a file or a link, not what a link leads to; nothing happens if there is none. Throws
// IoError.
void remove_file(const std::filesystem::path& path);

// Makes a folder within one that the program works in, or finds it there. Throws IoError if it is a
// link, through which files of others could be written over, or a file.
void make_inner_folder(const std::filesystem::path& path);

// Is it what a writer that was killed has left (durable_file.hpp)?
bool is_temporary_file(const std::filesystem::path& path);

// Deletes those directly in a folder, to which nobody else writes.
void remove_temporary_files(const std::filesystem::path& folder);

}  // namespace traceraft::posix
