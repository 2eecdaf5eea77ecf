#include "drivers/run/view_strip.hpp"

#include <algorithm>
#include <cmath>

#include "backends/gif/label.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::run {
namespace {

constexpr int kFooter = 56;  // pixels below the views: times, and below them the legend

// A square of `from` that begins at a column, at half its size.
void copy_half(const observables::Image& from, int first_column, observables::Image& to, int left,
               int top) {
  const int size = from.height / 2;
  const auto at = [&](int x, int y, int channel) {
    return int{from.rgb[3 * (static_cast<std::size_t>(y) * from.width + x) + channel]};
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        const int u = first_column + 2 * x, v = 2 * y;
        const int sum = at(u, v, channel) + at(u + 1, v, channel) + at(u, v + 1, channel) +
                        at(u + 1, v + 1, channel);
        to.rgb[3 * (static_cast<std::size_t>(top + y) * to.width + left + x) + channel] =
            static_cast<std::uint8_t>((sum + 2) / 4);
      }
}

// The largest of 1, 2 and 5 times a power of ten that is at most x.
double round_length(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= x) return factor * power;
  return power;
}

void draw_scale_bar(observables::Image& image, int size, int top, const StripLegend& legend) {
  const double length = round_length(0.6 * legend.half_width);
  const int pixels = static_cast<int>(std::lround(length / (2 * legend.half_width) * size));
  constexpr int kLeft = 8;
  observables::fill(image, kLeft, top + 6, pixels, 4, observables::kInk);
  gif::write_text(image, kLeft + pixels + 6, top, format_number(length) + " " + legend.length_unit);
}

void draw_colours(observables::Image& image, int top, const StripLegend& legend) {
  constexpr int kWidth = 60;
  const std::string low = "c = " + format_number(legend.dark), high = format_number(legend.bright);
  const int right = image.width - 8 - gif::text_width(high), left = right - 6 - kWidth;
  for (int x = 0; x < kWidth; ++x)
    observables::fill(image, left + x, top, 1, gif::kTextHeight,
                      observables::surface_colour((x + 0.5) / kWidth));
  gif::write_text(image, left - 6 - gif::text_width(low), top, low);
  gif::write_text(image, right, top, high);
}

}  // namespace

std::vector<std::size_t> strip_choice(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t shown = std::min(count, most);
  for (std::size_t k = 0; k < shown; ++k)
    chosen.push_back(shown == 1 ? 0 : (k * (count - 1) + (shown - 1) / 2) / (shown - 1));
  return chosen;
}

observables::Image compose_strip(const std::vector<StripView>& views, const StripLegend& legend) {
  const int size = views.front().front_and_back.height / 2;
  observables::Image strip;
  strip.width = size * static_cast<int>(views.size());
  strip.height = 2 * size + kFooter;
  strip.rgb.assign(3 * static_cast<std::size_t>(strip.width) * strip.height, 255);
  for (std::size_t k = 0; k < views.size(); ++k) {
    const auto& [image, label] = views[k];
    const int left = size * static_cast<int>(k);
    copy_half(image, 0, strip, left, 0);
    copy_half(image, image.width / 2, strip, left, size);
    gif::write_text(strip, left + (size - gif::text_width(label)) / 2, 2 * size + 8, label);
  }
  draw_scale_bar(strip, size, 2 * size + 34, legend);
  draw_colours(strip, 2 * size + 34, legend);
  return strip;
}

}  // namespace traceraft::run
