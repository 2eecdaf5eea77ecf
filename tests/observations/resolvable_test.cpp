#include "verification/observations/resolvable.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace traceraft::observations {
namespace {

MeasuredVesicles look(double perimeter, std::optional<double> fraction) {
  Measurement m{"a", 30, 5, {}, {}};
  m.values[static_cast<std::size_t>(Quantity::perimeter)] = perimeter;
  m.values[static_cast<std::size_t>(Quantity::fraction)] = fraction;
  MeasuredVesicles data;
  data.measurements = {m};
  return data;
}

// N small rafts of radius a have P = 2π N a/R and cover N π a² of 4π R².
TEST(Resolvable, NamesRaftsThatLightDoesNotShow) {
  const auto rafts = [](double radius) {
    constexpr int kRafts = 100;
    return look(2 * 3.14159265 * kRafts * radius / 5, kRafts * radius * radius / (4 * 25));
  };
  EXPECT_EQ(too_long_boundaries(rafts(0.11)), "");
  const std::string doubt = too_long_boundaries(rafts(0.08));
  EXPECT_NE(doubt.find("In 1 of 1 observations"), std::string::npos) << doubt;
  EXPECT_NE(doubt.find("0.16 um, are those of vesicle 'a' at 30 s"), std::string::npos) << doubt;
}

TEST(Resolvable, AsksAboutUnusualTimes) {
  MeasuredVesicles data = look(8, 0.1);
  for (const auto& [time, doubtful] : {std::pair(0.5, true), std::pair(30.0, false),
                                       std::pair(86000.0, false), std::pair(4e5, true)}) {
    data.measurements[0].time = time;
    EXPECT_EQ(unusual_times(data) != "", doubtful) << time;
  }
}

// Half of the surface, as much raft as possible, has the largest discs.
TEST(Resolvable, DoubtsNothingThatMayBe) {
  EXPECT_EQ(too_long_boundaries(look(620, std::nullopt)), "");
  EXPECT_NE(too_long_boundaries(look(640, std::nullopt)), "");
  // The phase that is not raft may be narrow as well.
  EXPECT_NE(too_long_boundaries(look(200, 0.95)), "");
  MeasuredVesicles nothing;
  nothing.measurements = {Measurement{"a", 30, 5, {}, {}}};
  EXPECT_EQ(too_long_boundaries(nothing), "");
}

// 50,000 rafts on a vesicle of 5 µm have some 30 nm.
TEST(Resolvable, NamesRaftsThatAreTooMany) {
  MeasuredVesicles data = look(0, 0.1);
  data.measurements[0].values[static_cast<std::size_t>(Quantity::rafts)] = 50000;
  const std::string doubt = too_long_boundaries(data);
  EXPECT_NE(doubt.find("0.028 um, are those of vesicle 'a' at 30 s"), std::string::npos) << doubt;
  data.measurements[0].values[static_cast<std::size_t>(Quantity::rafts)] = 50;
  EXPECT_EQ(too_long_boundaries(data), "");
}

// A cap that covers a tenth has a perimeter of 3.77 R.
TEST(Resolvable, NamesBoundariesShorterThanThatOfACap) {
  EXPECT_EQ(too_short_boundaries(look(3.5, 0.1)), "");
  EXPECT_EQ(too_short_boundaries(look(1.9, std::nullopt)), "");
  const std::string doubt = too_short_boundaries(look(1.92, 0.1));  // a diameter for the radius
  EXPECT_NE(doubt.find("0.51 times"), std::string::npos) << doubt;
  EXPECT_EQ(too_short_boundaries(look(3.5, 0.9)), "");
  EXPECT_NE(too_short_boundaries(look(1.9, 0.9)), "");
  MeasuredVesicles uncertain = look(3, 0.1);
  for (const double fraction : {0.1, 0.9}) {
    MeasuredVesicles sure = look(3.7, fraction);
    sure.measurements[0].sigma[static_cast<std::size_t>(Quantity::fraction)] = 0.06;
    EXPECT_EQ(too_short_boundaries(sure), "") << fraction;
  }
  EXPECT_NE(too_short_boundaries(uncertain), "");
  uncertain.measurements[0].sigma[static_cast<std::size_t>(Quantity::fraction)] = 0.03;
  EXPECT_EQ(too_short_boundaries(uncertain), "");
}

}  // namespace
}  // namespace traceraft::observations
