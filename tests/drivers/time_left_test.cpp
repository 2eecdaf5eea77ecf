#include "drivers/output/time_left.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace traceraft {
namespace {

TEST(TimeLeft, IsThatOfStepsThatGrowWithTime) {
  output::TimeLeft left(1e4);
  for (int k = 0; k <= 50; ++k) left.note(std::pow(10, 0.04 * k), k);
  EXPECT_NEAR(left.seconds(), 50, 1e-6);
  EXPECT_NEAR(left.share(), 0.5, 1e-6);
}

// Ten steps before the end there is little time for them to grow.
TEST(TimeLeft, IsNearlyThatOfStepsOfOneLengthAtTheEnd) {
  output::TimeLeft left(100);
  for (int k = 0; k <= 90; ++k) left.note(k, 2.0 * k);
  EXPECT_NEAR(left.seconds(), 20, 5);
  EXPECT_LE(left.seconds(), 20);
}

// A hundred steps, then ten short ones while a raft vanishes.
TEST(TimeLeft, IsNotWhatAFewShortStepsSay) {
  output::TimeLeft left(1000);
  double seconds = 0, before = 0;
  for (int k = 0; k < 110; ++k) {
    before = left.share();
    left.note(k < 100 ? k + 1 : 100 + 1e-3 * (k - 99), seconds += 1);
    EXPECT_GE(left.share(), before);
  }
  EXPECT_LT(left.seconds(), 1500);
  EXPECT_GT(left.seconds(), 100);
  left.note(1000, seconds + 1);
  EXPECT_EQ(left.share(), 1);
  EXPECT_EQ(left.seconds(), 0);
}

// An integrator that begins with a tiny step would be at the end soon if it went on so.
TEST(TimeLeft, IsUnknownWhileAnIntegratorFeelsItsWay) {
  output::TimeLeft left(200);
  for (int k = 0; k <= 40; ++k) left.note(1e-12 * std::pow(1.7, k), k);
  EXPECT_EQ(left.seconds(), 0);
  EXPECT_EQ(left.share(), 0);
}

// The time of every fifteenth step of two runs like the paper's vesicles, and what had been spent.
using Marks = std::vector<std::pair<double, double>>;
const Marks kTwoToOne = {
    {1.87e-05, 83}, {0.000415, 176}, {0.00284, 275}, {0.0139, 400}, {0.0408, 529}, {0.0775, 653},
    {0.151, 789},   {0.47, 959},     {0.72, 1222},   {0.912, 1438}, {1.12, 1585},  {1.83, 1936},
    {1.94, 2106},   {2.26, 2250},    {4.31, 2426},   {6.17, 2825},  {6.34, 3018},  {7.63, 3184},
    {9.09, 3670},   {9.29, 3801},    {11.3, 3975},   {18.1, 4261},  {19.2, 4729},  {19.6, 4880},
    {23.5, 5112},   {26.5, 5633},    {26.7, 5758},   {29.4, 5935},  {40, 6163},    {45.4, 6646},
    {45.6, 6892},   {46.5, 7061},    {53.4, 7252},   {85.8, 7469},  {180, 7714},   {237, 8103},
    {280, 8435},    {299, 8812},     {306, 9464},    {306, 9673},   {307, 9833},   {317, 10033},
    {400, 10290},   {546, 10609},    {627, 11126},   {689, 11398},  {739, 11853},  {762, 12172},
    {775, 12598},   {777, 13115},    {777, 13226},   {780, 13389},  {805, 13602},  {979, 13857},
    {1e+03, 13868}};
const Marks kThreeToOne = {
    {4.24e-05, 83}, {0.000823, 185}, {0.00712, 310}, {0.0299, 424}, {0.0861, 551}, {0.191, 685},
    {0.391, 818},   {0.631, 944},    {0.957, 1122},  {1.93, 1275},  {6.38, 1452},  {20.4, 1637},
    {41.6, 2085},   {42.1, 2377},    {43, 2518},     {50.7, 2702},  {60.1, 3333},  {60.4, 3441},
    {63.1, 3598},   {84, 3793},      {196, 4025},    {335, 4582},   {347, 5249},   {348, 5411},
    {350, 5572},    {370, 5774},     {487, 5991},    {964, 6397},   {1e+03, 6437}};

TEST(TimeLeft, IsWithinItsRangeInNineOfTenMoments) {
  int all = 0, within = 0;
  double ratio = 1;
  for (const Marks* marks : {&kTwoToOne, &kThreeToOne}) {
    output::TimeLeft left(marks->back().first);
    for (std::size_t k = 1; k < marks->size(); ++k) {
      const auto [t0, spent0] = (*marks)[k - 1];
      const auto [t1, spent1] = (*marks)[k];
      for (int step = 0; step < 15; ++step)
        left.note(t0 * std::pow(t1 / t0, step / 15.0), spent0 + (spent1 - spent0) * step / 15.0);
      const output::TimeLeft::Range range = left.range();
      if (!(range.high > 0)) continue;
      const double now = spent0 + (spent1 - spent0) * 14 / 15;
      const double truth = marks->back().second - now;
      ++all;
      within += range.low <= truth && truth <= range.high;
      ratio = std::max(ratio, range.high / range.low);
    }
  }
  EXPECT_GE(all, 70);
  EXPECT_GE(within, 0.9 * all);
  EXPECT_LT(ratio, 60);
}

TEST(TimeLeft, HasARangeAroundStepsOfOneLength) {
  output::TimeLeft left(100);
  for (int k = 1; k <= 60; ++k) left.note(k, 2.0 * k);
  EXPECT_LT(left.range().low, 80);
  EXPECT_GT(left.range().high, 80);
  EXPECT_EQ(output::TimeLeft(10).range().high, 0);
}

TEST(TimeLeft, IsUnknownAtFirst) {
  output::TimeLeft left(10);
  left.note(0, 0);
  EXPECT_EQ(left.seconds(), 0);
  EXPECT_EQ(left.share(), 0);
}

}  // namespace
}  // namespace traceraft
