#include <gtest/gtest.h>
#include <png.h>

#include <numeric>

#include "backends/png/png_file.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

std::array<int, 3> pixel(const observables::Image& image, int column, int row) {
  const std::size_t at = 3 * (static_cast<std::size_t>(row) * image.width + column);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

// The hemisphere that faces the viewer is bright, the other one dark.
TEST(SurfaceView, ShowsFrontAndBack) {
  const auto space = testing::make_space(32);
  const Point viewer(1, -0.8, 0.5);
  Vec values(space->surface.points.size());
  for (int p = 0; p < values.size(); ++p)
    values[p] = space->surface.position[p].dot(viewer) > 0 ? 1 : 0;
  const int size = 100;
  const observables::Image image = observables::draw_front_and_back(*space, values, 0, 1, size);
  ASSERT_EQ(image.width, 2 * size);
  ASSERT_EQ(image.height, size);
  const auto front = pixel(image, size / 2, size / 2), back = pixel(image, 3 * size / 2, size / 2);
  EXPECT_GT(front[0], 2 * front[2]) << "front is not yellow";
  EXPECT_GT(back[2], 2 * back[0]) << "back is not blue";
  EXPECT_EQ(pixel(image, 1, 1), (std::array<int, 3>{255, 255, 255}));
  // The disc fills π/4 of the square, less the margin of 5 %; nothing inside it is left white.
  int covered = 0;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      covered += pixel(image, column, row) != std::array<int, 3>{255, 255, 255};
  EXPECT_NEAR(covered / (size * size * M_PI / 4 / 1.05 / 1.05), 1, 0.04);
}

TEST(PngWriter, WritesWhatLibpngReads) {
  observables::Image image{3, 2, std::vector<std::uint8_t>(18)};
  std::iota(image.rgb.begin(), image.rgb.end(), std::uint8_t{100});
  const std::string bytes = png::png_bytes(image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()));
  EXPECT_EQ(header.width, 3u);
  EXPECT_EQ(header.height, 2u);
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(18);
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(read, image.rgb);
}

}  // namespace
}  // namespace traceraft
