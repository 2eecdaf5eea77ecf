#include "kernel/observables/surface_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace traceraft {
namespace {

constexpr int kSamples = 2;  // per pixel and direction

using Colour = std::array<double, 3>;
constexpr Colour kDark = {38, 70, 120}, kBright = {247, 193, 82}, kWhite = {255, 255, 255};

// The surface seen against `towards_viewer`, nearest piece in front.
class View {
 public:
  View(int size, double half_width, const Point& towards_viewer)
      : size_(size * kSamples),
        scale_(size_ / (2 * half_width)),
        out_(towards_viewer.normalized()),
        right_(Point(0, 0, 1).cross(out_).normalized()),
        up_(out_.cross(right_)),
        depth_(static_cast<std::size_t>(size_) * size_, -std::numeric_limits<double>::infinity()),
        colour_(depth_.size(), kWhite) {}

  void draw(const std::array<Point, 3>& corner, const std::array<double, 3>& share) {
    const Point normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (!(normal.dot(out_) > 0)) return;  // seen from inside
    // Light from above the viewer's left shoulder.
    const Point light = (out_ - 0.4 * right_ + 0.5 * up_).normalized();
    const double shade = 0.55 + 0.45 * std::max(0.0, normal.normalized().dot(light));
    std::array<double, 3> x, y, z;
    for (int i = 0; i < 3; ++i) {
      x[i] = 0.5 * size_ + scale_ * corner[i].dot(right_);
      y[i] = 0.5 * size_ - scale_ * corner[i].dot(up_);
      z[i] = corner[i].dot(out_);
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return;
    const auto [x_min, x_max] = std::minmax_element(x.begin(), x.end());
    const auto [y_min, y_max] = std::minmax_element(y.begin(), y.end());
    for (int row = first(*y_min); row <= last(*y_max); ++row)
      for (int column = first(*x_min); column <= last(*x_max); ++column) {
        const double px = column + 0.5, py = row + 0.5;
        const double b = ((px - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (py - y[0])) / area;
        const double c = ((x[1] - x[0]) * (py - y[0]) - (px - x[0]) * (y[1] - y[0])) / area;
        const double a = 1 - b - c;
        if (a < -1e-9 || b < -1e-9 || c < -1e-9) continue;
        set(row, column, a * z[0] + b * z[1] + c * z[2], a * share[0] + b * share[1] + c * share[2],
            shade);
      }
  }

  // What is in front on any of the ranks.
  void combine(const Communicator& ranks) {
    if (ranks.size() == 1) return;
    const auto samples = static_cast<Eigen::Index>(depth_.size());
    Vec nearest = Eigen::Map<const Vec>(depth_.data(), samples);
    ranks.max(nearest);
    for (std::size_t at = 0; at < depth_.size(); ++at)
      if (depth_[at] < nearest[static_cast<Eigen::Index>(at)]) colour_[at] = {-1, -1, -1};
    Eigen::Map<Vec> colours(colour_.data()->data(), 3 * samples);
    ranks.max(colours);
  }

  // Averages the samples of each pixel into `image`, starting at a column.
  void copy_to(Image& image, int first_column) const {
    const int pixels = size_ / kSamples;
    for (int row = 0; row < pixels; ++row)
      for (int column = 0; column < pixels; ++column)
        for (int channel = 0; channel < 3; ++channel) {
          double sum = 0;
          for (int i = 0; i < kSamples; ++i)
            for (int j = 0; j < kSamples; ++j)
              sum += colour_[index(row * kSamples + i, column * kSamples + j)][channel];
          const auto at = 3 * (static_cast<std::size_t>(row) * image.width + first_column + column);
          image.rgb[at + channel] =
              static_cast<std::uint8_t>(std::lround(sum / (kSamples * kSamples)));
        }
  }

 private:
  int first(double low) const { return std::max(0, static_cast<int>(std::floor(low - 0.5))); }
  int last(double high) const { return std::min(size_ - 1, static_cast<int>(std::ceil(high))); }
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * size_ + column;
  }
  void set(int row, int column, double depth, double share, double shade) {
    const std::size_t at = index(row, column);
    if (!(depth > depth_[at])) return;
    depth_[at] = depth;
    const double s = std::clamp(share, 0.0, 1.0);
    for (int channel = 0; channel < 3; ++channel)
      colour_[at][channel] = shade * ((1 - s) * kDark[channel] + s * kBright[channel]);
  }

  int size_;
  double scale_;
  Point out_, right_, up_;
  std::vector<double> depth_;
  std::vector<Colour> colour_;
};

Image draw(const std::vector<Point>& position, const std::vector<std::array<int, 3>>& triangles,
           const Vec& values, double low, double high, int size, const Communicator& ranks) {
  double farthest = 0;
  for (const Point& x : position) farthest = std::max(farthest, x.norm());
  farthest = ranks.max(farthest);
  const Point towards_viewer(1, -0.8, 0.5);
  Image image{2 * size, size, std::vector<std::uint8_t>(6 * static_cast<std::size_t>(size) * size)};
  View front(size, 1.05 * farthest, towards_viewer), back(size, 1.05 * farthest, -towards_viewer);
  for (const auto& [a, b, c] : triangles) {
    const auto share = [&](int p) { return (values[p] - low) / (high - low); };
    for (View* view : {&front, &back})
      view->draw({position[a], position[b], position[c]}, {share(a), share(b), share(c)});
  }
  front.combine(ranks);
  back.combine(ranks);
  front.copy_to(image, 0);
  back.copy_to(image, size);
  return image;
}

}  // namespace

Image draw_front_and_back(const SurfaceSpace& space, const Vec& values, double low, double high,
                          int size) {
  const CutSurface& surface = space.surface;
  return draw(surface.position, surface.triangles, values, low, high, size, *space.communicator);
}

Image draw_front_and_back(const SurfaceMesh& mesh, const Vec& values, double low, double high,
                          int size) {
  return draw(mesh.position, mesh.triangles, values, low, high, size, kAlone);
}

}  // namespace traceraft
