#include "kernel/observables/surface_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace traceraft::observables {
namespace {

constexpr int kSamples = 2;  // per pixel and direction

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kDark = {38, 70, 120}, kBright = {247, 193, 82}, kWhite = {255, 255, 255};

Colour shaded(double share, double shade) {
  const double s = std::clamp(share, 0.0, 1.0);
  Colour colour;
  for (int channel = 0; channel < 3; ++channel)
    colour[channel] =
        static_cast<std::uint8_t>(shade * ((1 - s) * kDark[channel] + s * kBright[channel]) + 0.5);
  return colour;
}

double half_width_of(const std::vector<Point>& position, const Communicator& ranks) {
  double farthest = 0;
  for (const Point& x : position) farthest = std::max(farthest, x.norm());
  return 1.05 * ranks.max(farthest);
}

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
    // The last two weights of the corners are affine: w(column, row) = w₀ + columns dx + rows dy.
    const auto weight = [&](int i, int j) {
      const double dx = (y[j] - y[i]) / area, dy = (x[i] - x[j]) / area;
      return Point((0.5 - x[i]) * dx + (0.5 - y[i]) * dy, dx, dy);
    };
    const Point b = weight(0, 2), c = -weight(0, 1), a = Point(1, 0, 0) - b - c;
    const auto mix = [&](const std::array<double, 3>& v) { return v[0] * a + v[1] * b + v[2] * c; };
    const Point depth = mix(z), part = mix(share);
    const auto [y_min, y_max] = std::minmax_element(y.begin(), y.end());
    for (int row = first(*y_min); row <= last(*y_max); ++row) {
      double low = 0, high = size_ - 1;  // the columns where no weight is negative
      for (const Point& w : {a, b, c}) {
        const double at_zero = w[0] + row * w[2] + 1e-9;
        if (w[1] > 0)
          low = std::max(low, -at_zero / w[1]);
        else if (w[1] < 0)
          high = std::min(high, -at_zero / w[1]);
        else if (at_zero < 0)
          high = -1;
      }
      for (int column = static_cast<int>(std::ceil(std::min<double>(low, size_))); column <= high;
           ++column)
        set(row, column, depth[0] + row * depth[2] + column * depth[1],
            part[0] + row * part[2] + column * part[1], shade);
    }
  }

  // Keeps what is in front on any of the ranks.
  void combine(const Communicator& ranks) {
    if (ranks.size() == 1) return;
    const auto samples = static_cast<Eigen::Index>(depth_.size());
    Vec nearest = Eigen::Map<const Vec>(depth_.data(), samples);
    ranks.max(nearest);
    Vec colours = Eigen::Map<const Eigen::Matrix<std::uint8_t, Eigen::Dynamic, 1>>(
                      colour_.data()->data(), 3 * samples)
                      .cast<double>();
    for (Eigen::Index at = 0; at < samples; ++at)
      if (depth_[at] < nearest[at]) colours.segment<3>(3 * at).setConstant(-1);
    ranks.max(colours);
    for (Eigen::Index at = 0; at < samples; ++at)
      for (int channel = 0; channel < 3; ++channel)
        colour_[at][channel] = static_cast<std::uint8_t>(colours[3 * at + channel]);
  }

  // Averages the samples of each pixel into `image`, starting at a column.
  void copy_to(Image& image, int first_column) const {
    const int pixels = size_ / kSamples;
    for (int row = 0; row < pixels; ++row)
      for (int column = 0; column < pixels; ++column)
        for (int channel = 0; channel < 3; ++channel) {
          int sum = 0;
          for (int i = 0; i < kSamples; ++i)
            for (int j = 0; j < kSamples; ++j)
              sum += colour_[index(row * kSamples + i, column * kSamples + j)][channel];
          const auto at = 3 * (static_cast<std::size_t>(row) * image.width + first_column + column);
          image.rgb[at + channel] =
              static_cast<std::uint8_t>((sum + kSamples * kSamples / 2) / (kSamples * kSamples));
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
    colour_[at] = shaded(share, shade);
  }

  int size_;
  double scale_;
  Point out_, right_, up_;
  std::vector<double> depth_;
  std::vector<Colour> colour_;
};

Image draw(const std::vector<Point>& position, const std::vector<std::array<int, 3>>& triangles,
           const Vec& values, double low, double high, int size, const Communicator& ranks) {
  const double half_width = half_width_of(position, ranks);
  const Point towards_viewer(1, -0.8, 0.5);
  Image image{2 * size, size, std::vector<std::uint8_t>(6 * static_cast<std::size_t>(size) * size)};
  View front(size, half_width, towards_viewer), back(size, half_width, -towards_viewer);
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

void fill(Image& image, int left, int top, int width, int height,
          const std::array<std::uint8_t, 3>& colour) {
  for (int y = std::max(top, 0); y < std::min(top + height, image.height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + width, image.width); ++x)
      std::copy(colour.begin(), colour.end(),
                image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + x));
}

double view_half_width(const fem::SurfaceSpace& space) {
  return half_width_of(space.surface.position, *space.communicator);
}

std::array<std::uint8_t, 3> surface_colour(double share) {
  return shaded(share, 1);
}

Image draw_front_and_back(const fem::SurfaceSpace& space, const Vec& values, double low,
                          double high, int size) {
  const mesh::CutSurface& surface = space.surface;
  return draw(surface.position, surface.triangles, values, low, high, size, *space.communicator);
}

Image draw_front_and_back(const SurfaceMesh& mesh, const Vec& values, double low, double high,
                          int size) {
  return draw(mesh.position, mesh.triangles, values, low, high, size, kAlone);
}

}  // namespace traceraft::observables
