#include "drivers/run/memory_need.hpp"

#include <unistd.h>

#include <cmath>

#include "kernel/core/error.hpp"
#include "kernel/core/text.hpp"
#include "kernel/mesh/active_mesh.hpp"

namespace traceraft::run {
namespace {

// Measured with 192 and 320 cells: set-up takes 2.8 kB per node, a run with `block` 7.4 kB.
constexpr double kBytesPerNode = 2.5e3;
constexpr std::int64_t kCoarse = 64, kFine = 512;

double physical_memory() {
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

}  // namespace

double nodes_of_fine_mesh(const geometry::LevelSet& surface, std::int64_t cells) {
  if (cells < kFine) return 0;
  try {
    const double finer = static_cast<double>(cells) / static_cast<double>(kCoarse);
    return mesh::build_active_mesh(surface, kCoarse).nodes() * finer * finer;
  } catch (const InputError&) {
    return 0;  // the mesh itself will be refused
  }
}

double least_memory(const geometry::LevelSet& surface, std::int64_t cells, int ranks) {
  return kBytesPerNode * nodes_of_fine_mesh(surface, cells) / ranks;
}

std::string memory_complaint(std::int64_t cells, double need, double there_is) {
  constexpr double kGigabyte = 1e9;
  if (need <= there_is) return "";
  const double fitting = static_cast<double>(cells) * std::sqrt(there_is / need);
  return formatted(
      "%lld per edge need at least %.0f GB of memory on each rank, and this machine has %.0f GB; "
      "choose %.0f at most, or ranks on several machines",
      static_cast<long long>(cells), need / kGigabyte, there_is / kGigabyte, fitting);
}

void refuse_too_fine(const config::Configuration& configuration, const geometry::LevelSet& surface,
                     const Communicator& ranks) {
  const std::int64_t cells = configuration.options().cells;
  const std::string complaint =
      memory_complaint(cells, least_memory(surface, cells, ranks.size()), physical_memory());
  if (!complaint.empty())
    throw InputError(configuration.where(&config::RunOptions::cells) + ": " + complaint);
}

}  // namespace traceraft::run
