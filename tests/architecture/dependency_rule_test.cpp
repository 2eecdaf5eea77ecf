// Dependencies point one way: drivers → verification, backends → kernel. The kernel includes the
// standard library and Eigen only; a backend folder includes the kernel and one library.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the root
  std::string target;  // what stands between the quotes or brackets
  bool quoted;
};

std::vector<Include> includes_below(const std::string& folder) {
  const fs::path root = TRACERAFT_ROOT;
  std::vector<Include> result;
  for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
    const std::string extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      if (line.compare(0, 9, "#include ") != 0) continue;
      const bool quoted = line[9] == '"';
      const std::string target = line.substr(10, line.find(quoted ? '"' : '>', 10) - 10);
      result.push_back({fs::relative(entry.path(), root).string(), target, quoted});
    }
  }
  EXPECT_FALSE(result.empty()) << folder;
  return result;
}

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool is_standard(const std::string& header) {
  return header.find('/') == std::string::npos && header.find('.') == std::string::npos;
}

// The top folder of an include, or "" for the standard library.
std::string library_of(const Include& include) {
  if (include.quoted) return include.target.substr(0, include.target.find('/'));
  if (is_standard(include.target)) return "";
  if (starts_with(include.target, "Eigen/")) return "Eigen";
  return include.target;
}

TEST(DependencyRule, KernelKnowsTheStandardLibraryAndEigenOnly) {
  for (const Include& include : includes_below("kernel")) {
    const std::string library = library_of(include);
    EXPECT_TRUE(library.empty() || library == "Eigen" || library == "kernel")
        << include.file << " includes " << include.target;
  }
}

TEST(DependencyRule, EveryBackendKnowsTheKernelAndItsOwnLibrary) {
  const std::map<std::string, std::vector<std::string>> own = {
      {"euler", {}},
      {"rosenbrock", {}},
      {"mpi", {"mpi.h"}},
      {"trilinos", {"Belos", "MueLu", "Stratimikos", "Teko", "Teuchos", "Thyra", "Tpetra"}},
      {"suitesparse", {"suitesparse/"}},
      {"sundials", {"sundials/", "sunlinsol/", "sunnonlinsol/", "ida/"}},
      {"muparser", {"muParser.h"}},
      {"nlopt", {"nlopt.h"}},
      {"openblas", {"cblas.h"}},
      {"sodium", {"sodium.h"}},
      {"gif", {"gif_lib.h"}},
      {"png", {"png.h"}},
      {"posix",
       {"fcntl.h", "fnmatch.h", "spawn.h", "unistd.h", "sys/file.h", "sys/mman.h", "sys/prctl.h",
        "sys/random.h", "sys/stat.h", "sys/ioctl.h", "sys/resource.h", "sys/wait.h"}},
      {"zlib", {"zlib.h"}}};
  for (const auto& entry : fs::directory_iterator(fs::path(TRACERAFT_ROOT) / "backends")) {
    if (!entry.is_directory()) continue;
    const std::string name = entry.path().filename();
    ASSERT_TRUE(own.count(name)) << "say here which library backends/" << name << " is for";
    for (const Include& include : includes_below("backends/" + name)) {
      if (include.quoted) {
        EXPECT_TRUE(starts_with(include.target, "kernel/") ||
                    starts_with(include.target, "backends/" + name + "/"))
            << include.file << " includes " << include.target;
      } else if (!is_standard(include.target) && !starts_with(include.target, "Eigen/")) {
        const auto& allowed = own.at(name);
        EXPECT_TRUE(std::any_of(
            allowed.begin(), allowed.end(),
            [&](const std::string& start) { return starts_with(include.target, start); }))
            << include.file << " includes " << include.target;
      }
    }
  }
}

TEST(DependencyRule, VerificationDoesNotKnowTheDrivers) {
  for (const Include& include : includes_below("verification"))
    EXPECT_FALSE(starts_with(include.target, "drivers/")) << include.file;
  for (const char* folder : {"kernel", "backends", "verification", "drivers"})
    for (const Include& include : includes_below(folder))
      EXPECT_FALSE(starts_with(include.target, "tests/")) << include.file;
}

// Folders below `top` that include each other in a cycle, or what is in one.
std::set<std::string> folders_in_cycles(const std::string& top) {
  const auto folder_of = [&](const std::string& path) {
    const std::size_t first = top.size() + 1;
    return path.substr(first, path.find('/', first) - first);
  };
  std::map<std::string, std::set<std::string>> uses;
  for (const Include& include : includes_below(top))
    if (starts_with(include.target, top + "/"))
      uses[folder_of(include.file)].insert(folder_of(include.target));
  // Take away what uses nothing that is left, until there is no such folder.
  const auto is_free = [&](const auto& entry) {
    return std::all_of(entry.second.begin(), entry.second.end(), [&](const std::string& target) {
      return target == entry.first || !uses.count(target);
    });
  };
  for (auto next = uses.begin();
       (next = std::find_if(uses.begin(), uses.end(), is_free)) != uses.end();)
    uses.erase(next);
  std::set<std::string> left;
  for (const auto& entry : uses) left.insert(entry.first);
  return left;
}

TEST(DependencyRule, FoldersHaveNoCycles) {
  for (const char* top :
       {"kernel", "verification", "verification/assimilation", "verification/selection", "drivers"})
    for (const std::string& folder : folders_in_cycles(top))
      ADD_FAILURE() << top << "/" << folder << " is part of a cycle, or uses one";
}

// kernel/fem/space.hpp: traceraft::fem. The vocabulary of kernel/core is in traceraft itself; a
// folder in a folder of verification shares the namespace of that one.
std::string namespace_of(const fs::path& file) {
  const std::string top = *file.begin(), folder = *std::next(file.begin());
  if (folder == "core") return "traceraft";
  return "traceraft::" + (std::next(file.begin(), 2) == file.end() ? top : folder);
}

TEST(NamespaceRule, EveryFolderHasItsOwn) {
  const fs::path root = TRACERAFT_ROOT;
  for (const char* top : {"kernel", "backends", "verification", "drivers"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const fs::path file = fs::relative(entry.path(), root);
      if (file.extension() != ".hpp" && file.extension() != ".cpp") continue;
      if (file == "drivers/main.cpp") continue;  // main is in no namespace
      std::ifstream in(entry.path());
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      const std::string opening = "\nnamespace " + namespace_of(file);
      EXPECT_TRUE(text.find(opening + " {") != std::string::npos ||
                  text.find(opening + "::") != std::string::npos)
          << file << " is not in " << namespace_of(file);
    }
}

TEST(TopLevelFolders, AreFixed) {
  const std::set<std::string> expected = {"kernel", "backends",     "drivers",
                                          "tests",  "verification", "docs"};
  for (const auto& entry : fs::directory_iterator(TRACERAFT_ROOT)) {
    const std::string name = entry.path().filename();
    if (entry.is_directory() && name[0] != '.' && name != "build" && name != "runs") {
      EXPECT_TRUE(expected.count(name)) << name;
    }
  }
}

}  // namespace
}  // namespace traceraft
