#include "backends/gif/label.hpp"

#include <gtest/gtest.h>

namespace traceraft {
namespace {

observables::Image white(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * height, 255)};
}

// Dark pixels of some columns and rows.
int ink(const observables::Image& image, int left, int right, int top, int bottom) {
  int count = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      count += image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)] < 128;
  return count;
}

TEST(Label, StandsInTheMiddleOfTheBottom) {
  observables::Image image = white(100, 60);
  gif::write_label(image, "L");
  EXPECT_EQ(ink(image, 0, 100, 0, 48), 0);
  EXPECT_EQ(ink(image, 0, 46, 48, 60) + ink(image, 54, 100, 48, 60), 0);
  // Upright and not mirrored: the stem is on the left, the foot at the bottom.
  EXPECT_GT(ink(image, 46, 50, 48, 52), ink(image, 50, 54, 48, 52));
  EXPECT_GT(ink(image, 50, 54, 52, 60), ink(image, 50, 54, 48, 52));
}

TEST(Label, GrowsWithThePictureAndIsCutAtItsEdge) {
  observables::Image small = white(400, 240), large = white(800, 480);
  gif::write_label(small, "t = 1 s");
  gif::write_label(large, "t = 1 s");
  EXPECT_EQ(ink(large, 0, 800, 0, 480), 4 * ink(small, 0, 400, 0, 240));
  observables::Image narrow = white(20, 30);
  gif::write_label(narrow, "t = 123456789 s");
  EXPECT_GT(ink(narrow, 0, 20, 0, 30), 0);
}

}  // namespace
}  // namespace traceraft
