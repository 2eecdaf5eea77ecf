// The folder of an ensemble: runs that differ in their seed only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/config/configuration.hpp"
#include "verification/observations/history.hpp"

namespace traceraft::ensemble {

inline constexpr int kMostRuns = 100000;

struct EnsemblePlan {
  int runs = 10;
  std::uint64_t first_seed = 1;

  std::uint64_t last_seed() const { return first_seed + static_cast<std::uint64_t>(runs) - 1; }
  std::vector<std::uint64_t> seeds() const;  // ascending
  bool operator==(const EnsemblePlan& other) const {
    return runs == other.runs && first_seed == other.first_seed;
  }
};

enum class MemberEnd { missing, begun, finished, failed };

class EnsembleFolder {
 public:
  explicit EnsembleFolder(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path plan_file() const { return path_ / "plan.json"; }
  std::filesystem::path config() const { return path_ / "config.toml"; }
  bool started() const {
    return std::filesystem::exists(config()) && std::filesystem::exists(plan_file());
  }

  // Throws InputError if there is a plan of something else.
  void refuse_other_plan() const;

  void save(const EnsemblePlan& plan) const;
  EnsemblePlan load() const;  // throws IoError if it is damaged

  std::filesystem::path run_of(std::uint64_t seed) const;
  std::filesystem::path log_of(std::uint64_t seed) const;

  // The state of a member, and why it failed; one whose summary is damaged has failed.
  struct Member {
    MemberEnd end;
    std::string why;
  };
  Member member(std::uint64_t seed) const;

  // The last time in its series, in the units of its files; 0 if there is none.
  double reached(std::uint64_t seed) const;

  // The history of a member that has begun; perimeters are divided by `radius`, given in the units
  // of the files. Throws InputError or IoError if its series is damaged.
  observations::History history(std::uint64_t seed, double radius) const;

 private:
  [[noreturn]] void refuse_plan() const;

  std::filesystem::path path_;
};

struct MemberFailure {
  std::uint64_t seed;
  std::string why;
  bool locked = false;  // another process works on it
};

// All members that have finished, in the order of their seeds. Damaged: those that say so, but
// whose series cannot be read or ends before it should; the others do not depend on them.
struct FinishedMembers {
  std::vector<std::uint64_t> seeds;
  std::vector<observations::History> histories;  // theirs
  std::vector<MemberFailure> damaged;
};
// `configuration`: of the ensemble. A run with other options than these is damaged, too.
FinishedMembers finished_members(const EnsembleFolder& folder,
                                 const config::Configuration& configuration);

}  // namespace traceraft::ensemble
