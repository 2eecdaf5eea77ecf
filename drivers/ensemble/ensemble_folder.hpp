// The folder of an ensemble: runs that differ in their seed only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "verification/vesicles/history.hpp"

namespace traceraft {

struct EnsemblePlan {
  int runs = 10;
  std::uint64_t first_seed = 1;

  std::uint64_t last_seed() const { return first_seed + static_cast<std::uint64_t>(runs) - 1; }
  std::vector<std::uint64_t> seeds() const;  // ascending
};

enum class MemberEnd { missing, begun, finished, failed };

class EnsembleFolder {
 public:
  explicit EnsembleFolder(std::filesystem::path path) : path_(std::move(path)) {}
  const std::filesystem::path& path() const { return path_; }
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

  // What is there of a member, and why it failed. Throws IoError if its summary is damaged.
  struct Member {
    MemberEnd end;
    std::string why;
  };
  Member member(std::uint64_t seed) const;

  // The last time in its series, in the units of its files; 0 if there is none.
  double reached(std::uint64_t seed) const;

  // Of a member that has begun; perimeters are divided by `radius`, given in the units of the
  // files.
  History history(std::uint64_t seed, double radius) const;

 private:
  std::filesystem::path plan_file() const { return path_ / "plan.json"; }
  std::filesystem::path path_;
};

// Of all members that have finished, in the order of their seeds.
std::vector<std::uint64_t> finished_seeds(const EnsembleFolder& folder, const EnsemblePlan& plan);
std::vector<History> finished_histories(const EnsembleFolder& folder, const EnsemblePlan& plan,
                                        double radius);

}  // namespace traceraft
