// view.png: a surface at several times side by side, front above back.
#pragma once

#include <string>
#include <vector>

#include "kernel/observables/surface_view.hpp"

namespace traceraft::run {

struct StripView {
  observables::Image front_and_back;  // as draw_front_and_back makes it
  std::string label;                  // "t = 12 s"
};

// The meaning of the scale bar's length and of the ends of the colours.
struct StripLegend {
  double half_width;        // of each view, in the unit of lengths
  std::string length_unit;  // "um"
  double dark, bright;      // c in these colours
};

// All views of one size, which is an even number of pixels; each is shown at half of that.
observables::Image compose_strip(const std::vector<StripView>& views, const StripLegend& legend);

// The pictures of `count` that a strip shows: at most `most`, evenly spread, the first and the last
// among them. Ascending.
std::vector<std::size_t> strip_choice(std::size_t count, std::size_t most = 6);

}  // namespace traceraft::run
