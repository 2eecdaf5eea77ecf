#include "drivers/output/chart.hpp"

#include <gtest/gtest.h>

#include "backends/posix/durable_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

// The labelled tics of y.
std::string tics_of(const std::vector<double>& y) {
  const testing::TemporaryFolder folder;
  bench::Chart chart{"a chart", "t", "y", true, true, {{"y", {}, bench::Mark::line}}};
  for (std::size_t k = 0; k < y.size(); ++k)
    chart.series[0].points.emplace_back(1 + static_cast<double>(k), y[k]);
  (void)output::draw_chart(chart, folder.path / "chart");
  const std::string script = posix::read_file(folder.path / "chart.gp", 1 << 20);
  const std::size_t begin = script.find("set ytics (") + 11;
  return script.substr(begin, script.find(')', begin) - begin);
}

TEST(Chart, HasAFewLabelsOnALogarithmicAxisOfAnyLength) {
  EXPECT_EQ(tics_of({1, 1, 1}), "0.8, 0.9, 1, 1.1, 1.2");
  EXPECT_EQ(tics_of({1}), tics_of({1, 1}));
  EXPECT_NE(tics_of({1.25, 1.2500001}).find("1.2, "), std::string::npos);
  EXPECT_NE(tics_of({3, 7}).find("3, 4, 5, 6, 7, 8"), std::string::npos) << tics_of({3, 7});
  EXPECT_NE(tics_of({3, 300}).find("10, 20, '' 30 1, '' 40 1, 50, "), std::string::npos);
}

// A curve that falls to 0 goes down to the edge of a logarithmic chart, with all times there are.
TEST(Chart, EndsBandsAtTheAxis) {
  const testing::TemporaryFolder folder;
  const bench::Chart chart{
      "a chart", "t",  "y",
      true,      true, {{"runs", {{1, 4}, {2, 0}, {8, 0}}, bench::Mark::band, {5, 3, 0}}}};
  (void)output::draw_chart(chart, folder.path / "chart");
  const std::string script = posix::read_file(folder.path / "chart.gp", 1 << 20);
  EXPECT_NE(script.find("set xrange [1:8]"), std::string::npos) << script;
  EXPECT_NE(script.find("END\n1 4 5\n2 2.5"), std::string::npos) << script;  // 3/1.18
  EXPECT_EQ(script.find("\n8 "), std::string::npos) << script;
}

}  // namespace
}  // namespace traceraft
