#include "drivers/report/surface_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "backends/posix/durable_file.hpp"
#include "backends/zlib/vtu_reader.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::report {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 33;

// All pieces of one time.
zlib::SurfaceField read_field(const fs::path& path) {
  try {
    if (path.extension() != ".pvtu")
      return zlib::read_vtu(posix::read_file(path, kLargestFile), "c");
    zlib::SurfaceField whole;
    for (const std::string& name : zlib::pieces_of_pvtu(posix::read_file(path, kLargestFile))) {
      const zlib::SurfaceField piece =
          zlib::read_vtu(posix::read_file(path.parent_path() / name, kLargestFile), "c");
      const int first = static_cast<int>(whole.mesh.position.size());
      whole.mesh.position.insert(whole.mesh.position.end(), piece.mesh.position.begin(),
                                 piece.mesh.position.end());
      for (const auto& [a, b, c] : piece.mesh.triangles)
        whole.mesh.triangles.push_back({a + first, b + first, c + first});
      Vec joined(whole.values.size() + piece.values.size());
      joined << whole.values, piece.values;
      whole.values = joined;
    }
    return whole;
  } catch (const IoError& error) {
    throw IoError(path.string() + ": " + error.what());
  }
}

// Points that share a cell of a grid become their mean. Pieces of several ranks, and fields that
// were written on other numbers of ranks, have the same points in other orders.
class Grid {
 public:
  Grid(const zlib::SurfaceField& field, double detail) : width_(detail * size_of(field.mesh)) {
    for (const Point& x : field.mesh.position)
      cells_.emplace(cell_of(x), static_cast<int>(cells_.size()));
  }

  // The cell of each point of a field; none if they are not the cells of this grid.
  std::optional<std::vector<int>> clusters(const zlib::SurfaceField& field) const {
    std::vector<int> clusters;
    std::vector<bool> seen(cells_.size(), false);
    for (const Point& x : field.mesh.position) {
      const auto cell = cells_.find(cell_of(x));
      if (cell == cells_.end()) return std::nullopt;
      clusters.push_back(cell->second);
      seen[static_cast<std::size_t>(cell->second)] = true;
    }
    if (std::find(seen.begin(), seen.end(), false) != seen.end()) return std::nullopt;
    return clusters;
  }

  observables::SurfaceMesh mesh(const zlib::SurfaceField& field,
                                const std::vector<int>& clusters) const {
    observables::SurfaceMesh coarse;
    coarse.position.assign(cells_.size(), Point::Zero());
    std::vector<double> count(cells_.size(), 0);
    for (std::size_t p = 0; p < clusters.size(); ++p) {
      coarse.position[clusters[p]] += field.mesh.position[p];
      ++count[clusters[p]];
    }
    for (std::size_t k = 0; k < count.size(); ++k) coarse.position[k] /= count[k];
    std::set<std::array<int, 3>> there;
    for (const std::array<int, 3>& fine : field.mesh.triangles) {
      const std::array<int, 3> corners = {clusters[fine[0]], clusters[fine[1]], clusters[fine[2]]};
      if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
        continue;
      // Means may fold a thin triangle over, on others, or make the same of two: where one sees
      // through the surface, that would be a dark speck.
      if (normal(field.mesh, fine).dot(normal(coarse, corners)) > 0 &&
          there.insert(sorted(corners)).second)
        coarse.triangles.push_back(corners);
    }
    return coarse;
  }

  Vec values(const zlib::SurfaceField& field, const std::vector<int>& clusters) const {
    const auto cells = static_cast<Eigen::Index>(cells_.size());
    Vec sum = Vec::Zero(cells), count = Vec::Zero(cells);
    for (std::size_t p = 0; p < clusters.size(); ++p) {
      sum[clusters[p]] += field.values[static_cast<Eigen::Index>(p)];
      ++count[clusters[p]];
    }
    return sum.cwiseQuotient(count);
  }

 private:
  using Cell = std::array<long, 3>;
  static Point normal(const observables::SurfaceMesh& mesh, const std::array<int, 3>& corners) {
    const Point& a = mesh.position[corners[0]];
    return (mesh.position[corners[1]] - a).cross(mesh.position[corners[2]] - a);
  }
  static std::array<int, 3> sorted(std::array<int, 3> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  }
  static double size_of(const observables::SurfaceMesh& mesh) {
    double size = 0;
    for (const Point& x : mesh.position) size = std::max(size, x.norm());
    return size;
  }
  Cell cell_of(const Point& x) const {
    return {std::lround(x[0] / width_), std::lround(x[1] / width_), std::lround(x[2] / width_)};
  }
  double width_;
  std::map<Cell, int> cells_;
};

}  // namespace

SurfaceFrames read_frames(const fs::path& run_folder, double detail, int most) {
  const fs::path collection = run_folder / "fields.pvd";
  if (!fs::exists(collection))
    throw InputError(run_folder.string() + " has no fields (it ran with --no-fields)");
  auto files = zlib::files_of_pvd(posix::read_file(collection, kLargestFile));
  // Who needs space may have removed some.
  files.erase(
      std::remove_if(files.begin(), files.end(),
                     [&](const auto& file) { return !fs::exists(run_folder / file.second); }),
      files.end());
  if (files.empty())
    throw InputError(collection.string() + " names only fields that no longer exist");
  const auto count = static_cast<int>(files.size()), shown = std::min(count, std::max(most, 1));
  SurfaceFrames frames;
  std::optional<Grid> grid;
  for (int k = 0; k < shown; ++k) {
    const auto& [time, name] = files[shown == 1 ? count - 1 : (count - 1) * k / (shown - 1)];
    const zlib::SurfaceField field = read_field(run_folder / name);
    std::optional<std::vector<int>> clusters;
    if (grid) clusters = grid->clusters(field);
    if (!clusters) {
      grid.emplace(field, detail);
      clusters = grid->clusters(field);
      frames.meshes.push_back(grid->mesh(field, *clusters));
    }
    frames.times.push_back(time);
    frames.frames.push_back({frames.meshes.size() - 1, grid->values(field, *clusters)});
  }
  return frames;
}

}  // namespace traceraft::report
