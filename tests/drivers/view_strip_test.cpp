#include "drivers/run/view_strip.hpp"

#include <gtest/gtest.h>

#include "backends/png/png_file.hpp"

namespace traceraft {
namespace {

observables::Image uniform(int size, std::uint8_t front, std::uint8_t back) {
  observables::Image image{2 * size, size,
                           std::vector<std::uint8_t>(6 * static_cast<std::size_t>(size) * size)};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < 2 * size; ++x)
      for (int channel = 0; channel < 3; ++channel)
        image.rgb[3 * (static_cast<std::size_t>(y) * 2 * size + x) + channel] =
            x < size ? front : back;
  return image;
}

int red_at(const observables::Image& image, int x, int y) {
  return image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x)];
}

TEST(ViewStrip, ShowsTheFirstAndTheLastAndNoMoreThanAsked) {
  EXPECT_EQ(run::strip_choice(1), (std::vector<std::size_t>{0}));
  EXPECT_EQ(run::strip_choice(3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(run::strip_choice(17), (std::vector<std::size_t>{0, 3, 6, 10, 13, 16}));
}

TEST(ViewStrip, HasFrontsAboveBacksAndALegend) {
  constexpr int kSize = 200;
  const run::StripLegend legend{5, "um", 0, 1};
  const observables::Image strip = run::compose_strip(
      {{uniform(kSize, 10, 20), "t = 0 s"}, {uniform(kSize, 30, 40), "t = 1 s"}}, legend);
  EXPECT_EQ(strip.width, kSize);
  ASSERT_GT(strip.height, kSize);
  EXPECT_EQ(red_at(strip, 50, 50), 10);
  EXPECT_EQ(red_at(strip, 50, 150), 20);
  EXPECT_EQ(red_at(strip, 150, 50), 30);
  EXPECT_EQ(red_at(strip, 150, 150), 40);
  // The scale bar is 2 um of the 10 um that a view is wide: 20 pixels of 100.
  int longest = 0;
  for (int y = kSize; y < strip.height; ++y) {
    int run = 0;
    for (int x = 0; x < 32; ++x)
      longest = std::max(longest, run = red_at(strip, x, y) == 40 ? run + 1 : 0);
  }
  EXPECT_EQ(longest, 20);
  // A file holds the same image.
  EXPECT_EQ(png::image_of_png(png::png_bytes(strip)).rgb, strip.rgb);
  EXPECT_THROW(png::image_of_png("no image"), std::runtime_error);
}

}  // namespace
}  // namespace traceraft
