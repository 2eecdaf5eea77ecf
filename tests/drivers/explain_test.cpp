// `traceraft explain` as its user runs it, on measurements whose truth it is not told.
#include <gtest/gtest.h>

#include <algorithm>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/field_dataset.hpp"
#include "kernel/physics/units.hpp"
#include "tests/support/program.hpp"
#include "tests/support/small_vesicle.hpp"
#include "tests/support/temporary_folder.hpp"
#include "verification/bench/bench.hpp"
#include "verification/selection/blind/blind_case.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::refuses;

class ExplainTest : public ::testing::Test {
 protected:
  // A request for what a vesicle of 5 µm with ε = 0.75 µm and D = 1e-5 cm²/s would show.
  selection::BlindRequest request() const { return testing::searched_vesicle(); }
  selection::BlindCase draw(const std::string& effect,
                            double gap = selection::BlindRequest{}.gap) const {
    selection::BlindRequest asked = request();
    asked.gap = gap;
    if (!effect.empty()) asked.effects = {effect};
    selection::BlindCase drawn = selection::draw_blind_case(asked);
    write(drawn.vesicles);
    return drawn;
  }
  void write(std::vector<assimilation::FieldSeries> vesicles) const {
    input::FieldDataset data;
    data.name = "drawn";
    data.synthetic = true;
    data.radius_um = 5;
    data.blur_um = 0;
    data.vesicles = std::move(vesicles);
    for (assimilation::FieldSeries& vesicle : data.vesicles)
      for (assimilation::FieldSnapshot& snapshot : vesicle.snapshots)
        snapshot.time *= physics::Units().time();
    input::write_field_dataset(folder.path / "data", data, "drawn by a test");
  }
  std::string command(int cells = 15, int replicates = 49) const {
    return "explain --data " + (folder.path / "data").string() + " --epsilon 0.75 --cells " +
           std::to_string(cells) + " --most-effects 1 --threads " + std::to_string(threads) +
           " --replicates " + std::to_string(replicates) + " --out " +
           (folder.path / "out").string();
  }
  // Gravity, Ohta-Kawasaki and uptake, where it does not matter how many effects are looked for.
  const std::string few =
      " --without allen-cahn,asymmetry,bulk-mobility,cooling,exchange,line-tension,"
      "mobility-contrast,mobility-exponent,thermal";
  std::string command_of_few(int cells, const std::string& also_without = "",
                             int replicates = 49) const {
    return command(cells, replicates) + few + also_without;
  }
  nlohmann::json verdict() const { return testing::json_of(folder.path / "out" / "verdict.json"); }
  nlohmann::json explain(int cells = 15) const {
    const auto end = testing::traceraft(command(cells));
    EXPECT_EQ(end.code, 0) << end.output;
    return verdict();
  }
  static std::ptrdiff_t lines(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  }
  testing::TemporaryFolder folder;
  int threads = 1;
};

TEST_F(ExplainTest, NamesWhatWasHidden) {
  // Strong enough for its gap to be told to a tenth from the noise of so few values.
  const selection::BlindCase drawn = draw("uptake", 0.1);
  const nlohmann::json verdict = explain();
  EXPECT_EQ(verdict["effect"], "uptake") << verdict.dump(2);
  const nlohmann::json& rate = verdict["parameters"]["uptake.rate"];
  const double truth = drawn.truth[0].values[0] / physics::Units().time();
  EXPECT_NEAR(rate["value"], truth, 4 * rate["sigma"].get<double>());
  EXPECT_LT(rate["sigma"], 0.2 * truth);
  EXPECT_NEAR(verdict["noise"]["level"], drawn.noise, 0.05 * drawn.noise);
  // The gap that is left is to be expected of noise.
  const auto gap = [&](const char* which) { return verdict["gap"][which]["train"].get<double>(); };
  EXPECT_NEAR(gap("named"), gap("floor"), 0.03 * gap("floor"));
  EXPECT_GT(gap("base"), 1.05 * gap("floor"));
  // The second best is no better, and another one.
  EXPECT_GT(gap("placebo"), 1.001 * gap("named"));
  EXPECT_LT(gap("placebo"), gap("base"));
  const auto square = [&](const char* which) { return gap(which) * gap(which); };
  EXPECT_NEAR(verdict["closed"]["train"],
              (square("base") - square("named")) / (square("base") - square("floor")), 1e-9);
  EXPECT_NEAR(verdict["closed"]["train"], 1, 0.1);
  EXPECT_FALSE(verdict["where"].is_null());
  const nlohmann::json& again = verdict["rerun"];
  EXPECT_EQ(again["integrator"], "rosenbrock");
  EXPECT_EQ(again["confirms"], true);
  // The one remark is of D: bulk mobility is confounded with it whatever else is there.
  EXPECT_EQ(verdict["remarks"].size(), 1u) << verdict["remarks"];
  const nlohmann::json& range = verdict["diffusion_range"];
  EXPECT_LT(range["low"], 1e-5) << range;
  EXPECT_GT(range["high"], 1e-5) << range;
  // Within four standard deviations of a root mean square of the 1,200 values held out.
  EXPECT_NEAR(again["named"]["heldout"], again["floor"]["heldout"],
              4 / std::sqrt(2 * 1200.0) * gap("floor"));
  EXPECT_LT(verdict["bounds"]["bulk-mobility.strength"]["high"], 1);
  EXPECT_FALSE(verdict["bounds"].contains("uptake.rate"));
  EXPECT_TRUE(testing::names(testing::content(folder.path / "out" / "explain.html"), "uptake"));
  // The model that it has written is one.
  const auto end =
      testing::traceraft("run --config " + (folder.path / "out" / "model.toml").string() +
                         " --t-end 0.01 --out " + (folder.path / "run").string());
  EXPECT_EQ(end.code, 0) << end.output;
}

TEST_F(ExplainTest, NamesNothingWhereNothingIsHidden) {
  draw("");
  const nlohmann::json verdict = explain(13);
  EXPECT_EQ(verdict["verdict"], "none") << verdict.dump(2);
  EXPECT_TRUE(verdict["effect"].is_null());
  EXPECT_TRUE(verdict["gap"]["placebo"]["train"].is_null());
  EXPECT_NEAR(verdict["parameters"]["diffusion"]["value"], 1e-5, 0.05e-5);
}

// A killed search goes on from its last refit and ends as if nothing had happened.
TEST_F(ExplainTest, GoesOnWhereItWasKilled) {
  constexpr int kCells = 10;
  selection::BlindRequest asked = request();
  asked.effects = {"uptake"};
  asked.gap = 0.2;
  asked.points = 500;
  asked.last = 90;
  write(selection::draw_blind_case(asked).vesicles);
  const pid_t child = testing::start_traceraft(command_of_few(kCells));
  const fs::path saved = folder.path / "out" / "search.json";
  const auto has_a_refit = [&] {
    return fs::exists(saved) && !testing::json_of(saved)["refits"].empty();
  };
  while (!has_a_refit() && waitpid(child, nullptr, WNOHANG) == 0) usleep(20000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(has_a_refit());
  threads = 2;  // which makes no difference
  const auto end = testing::traceraft(command_of_few(kCells));
  threads = 1;
  ASSERT_EQ(end.code, 0) << end.output;
  const nlohmann::json resumed = verdict();
  // A search that is over is only told again.
  const auto searched = fs::last_write_time(saved);
  const auto again = testing::traceraft(command_of_few(kCells));
  EXPECT_EQ(fs::last_write_time(saved), searched);
  EXPECT_EQ(verdict(), resumed);
  fs::remove_all(folder.path / "out");
  const auto at_once = testing::traceraft(command_of_few(kCells));
  ASSERT_EQ(at_once.code, 0) << at_once.output;
  // Every step is told in a line of its own.
  EXPECT_LT(lines(again.output), lines(end.output)) << again.output;
  EXPECT_LT(lines(end.output), lines(at_once.output)) << end.output << at_once.output;
  const nlohmann::json whole = verdict();
  EXPECT_EQ(whole["effect"], "uptake");
  EXPECT_EQ(resumed.dump(2), whole.dump(2));
  // Another search does not take its place.
  for (const auto& [changed, what] :
       {std::pair(command_of_few(kCells, ",gravity"), "--without"),
        std::pair(command_of_few(kCells, "", 59), "--replicates"),
        std::pair(command_of_few(kCells) + " --diffusion-error 0.1", "--diffusion-error")})
    EXPECT_TRUE(refuses(testing::traceraft(changed), what)) << changed;
}

// Vesicles with few snapshots tell together what one of them tells with more.
TEST_F(ExplainTest, JoinsWhatVesiclesSay) {
  selection::BlindRequest asked = request();
  asked.effects = {"uptake"};
  asked.vesicles = 2;
  asked.snapshots = 3;
  asked.points = 1000;
  const selection::BlindCase drawn = selection::draw_blind_case(asked);
  ASSERT_EQ(drawn.vesicles.size(), 2u);
  EXPECT_NE(drawn.vesicles[0].snapshots[0].values[0], drawn.vesicles[1].snapshots[0].values[0]);
  write(drawn.vesicles);
  ASSERT_EQ(testing::traceraft(command_of_few(11)).code, 0);
  const nlohmann::json found = verdict();
  EXPECT_EQ(found["effect"], "uptake") << found.dump(2);
  const nlohmann::json& rate = found["parameters"]["uptake.rate"];
  EXPECT_NEAR(rate["value"], drawn.truth[0].values[0] / physics::Units().time(),
              4 * rate["sigma"].get<double>());

  // The model that has what was found lacks nothing; its rate is fitted once more.
  const std::string out = (folder.path / "again").string();
  const auto again = testing::traceraft("explain --data " + (folder.path / "data").string() +
                                        " --model " + (folder.path / "out/model.toml").string() +
                                        few + " --threads 1 --replicates 49 --out " + out);
  ASSERT_EQ(again.code, 0) << again.output;
  const auto whole = testing::json_of(out + "/verdict.json");
  EXPECT_EQ(whole["verdict"], "none") << whole.dump(2);
  EXPECT_TRUE(whole["effect"].is_null());
  const nlohmann::json& same = whole["parameters"]["uptake.rate"];
  EXPECT_NEAR(same["value"], rate["value"].get<double>(), 0.2 * rate["sigma"].get<double>());
  EXPECT_NEAR(same["sigma"], rate["sigma"].get<double>(), 0.5 * rate["sigma"].get<double>());
  EXPECT_FALSE(whole["bounds"].contains("uptake.rate"));
  EXPECT_EQ(std::count(whole["not_looked_for"].begin(), whole["not_looked_for"].end(), "uptake"),
            0);
  EXPECT_TRUE(testing::names(whole["model"]["effect"], "uptake:rate="));
}

TEST_F(ExplainTest, SaysWhatIsOddAboutTheData) {
  selection::BlindRequest asked = request();
  asked.snapshots = 4;
  asked.points = 600;
  asked.last = 90;
  std::vector<assimilation::FieldSeries> vesicles = selection::draw_blind_case(asked).vesicles;
  std::vector<assimilation::FieldSnapshot>& snapshots = vesicles[0].snapshots;
  for (Point& x : snapshots[2].points)
    x = Point(std::cos(0.3) * x[0] - std::sin(0.3) * x[1],
              std::sin(0.3) * x[0] + std::cos(0.3) * x[1], x[2]);
  for (int k = 0; k < 5; ++k) snapshots[1].values[100 * k] = 4;
  vesicles[0].vesicle = "7";
  write(vesicles);
  const auto end = testing::traceraft(command_of_few(10));
  ASSERT_EQ(end.code, 0) << end.output;
  const nlohmann::json found = testing::json_of(folder.path / "out/search.json")["so_far"];
  EXPECT_EQ(found["outliers"], 5);
  // Turned before the third snapshot, and back before the fourth.
  const nlohmann::json& turns = found["registered"];
  ASSERT_EQ(turns.size(), 2u) << turns;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(turns[k]["snapshot"], 2 + k);
    // Patterns change between snapshots, and 600 points on 10 cells know no angle to a tenth.
    EXPECT_NEAR(turns[k]["angle"], 0.3, 0.15);
  }
  EXPECT_TRUE(found["frames"].empty()) << found["frames"];
  EXPECT_GE(verdict()["remarks"].size(), 2u);
}

// A vesicle with nothing hidden, in three snapshots of few points.
class ExplainRefusalTest : public ExplainTest {
 protected:
  ExplainRefusalTest() {
    asked_.snapshots = 3;
    asked_.points = 150;
    vesicles_ = selection::draw_blind_case(asked_).vesicles;
    write(vesicles_);
  }
  testing::ProgramEnd checked() const {
    const auto end = testing::traceraft("data check " + (folder.path / "data").string());
    EXPECT_EQ(end.code, 0) << end.output;
    return end;
  }
  assimilation::FieldSnapshot& snapshot(std::size_t k) { return vesicles_[0].snapshots[k]; }

  selection::BlindRequest asked_ = request();
  std::vector<assimilation::FieldSeries> vesicles_;
};

TEST_F(ExplainRefusalTest, NeedsDataAndAModel) {
  const std::string data = " --data " + (folder.path / "data").string();
  EXPECT_TRUE(refuses(testing::traceraft("explain"), "--data"));
  EXPECT_TRUE(refuses(testing::traceraft("explain" + data), "--model"));
  fs::remove(folder.path / "data/dataset.toml");
  EXPECT_TRUE(refuses(testing::traceraft("explain" + data), "dataset.toml"));
}

TEST_F(ExplainRefusalTest, LeavesFoldersOfOthersAlone) {
  const std::string explain = "explain --data " + (folder.path / "data").string();
  fs::create_directories(folder.path / "mine");
  posix::write_durably(folder.path / "mine" / "notes.txt", "mine");
  EXPECT_TRUE(refuses(testing::traceraft(explain + " --epsilon 0.75 --cells 13 --out " +
                                         (folder.path / "mine").string()),
                      "notes.txt"));
  // The model that was found would take the place of the one that was given.
  fs::create_directories(folder.path / "out");
  const fs::path own = folder.path / "out" / "model.toml";
  posix::write_durably(own, "epsilon = 0.75\ncells = 13\n");
  EXPECT_TRUE(refuses(testing::traceraft(explain + " --model " + own.string() + " --out " +
                                         (folder.path / "out").string()),
                      "--out: " + (folder.path / "out").string()));
  EXPECT_EQ(testing::content(own), "epsilon = 0.75\ncells = 13\n");
}

TEST_F(ExplainRefusalTest, NeedsEffectsThatCanBeFitted) {
  for (const char* effect : {"thermal:strength=0.1,time=1", "curvature:strength=0.1"})
    EXPECT_TRUE(refuses(testing::traceraft(command(13) + " --effect " + effect), "--effect"))
        << effect;
  // On a sphere there is no other one than curvature.
  EXPECT_TRUE(refuses(
      testing::traceraft(
          command(13) +
          " --without allen-cahn,asymmetry,brownian-flow,bulk-mobility,cooling,exchange,"
          "gravity,flow,line-tension,mobility-contrast,mobility-exponent,ohta-kawasaki,uptake"),
      "--without"));
}

TEST_F(ExplainRefusalTest, SaysWhichPointIsOff) {
  EXPECT_FALSE(testing::names(checked().output, "snapshot_002.csv:9"));
  snapshot(1).points[7] *= 1.3;
  write(vesicles_);
  EXPECT_TRUE(testing::names(checked().output, "snapshot_002.csv:9: "));
  EXPECT_TRUE(testing::names(checked().output, " 0.3 R,"));
  EXPECT_TRUE(refuses(testing::traceraft(command(13)), "snapshot_002.csv:9: "));
}

TEST_F(ExplainRefusalTest, SaysWhichValueIsNone) {
  snapshot(1).values[7] = -9999;
  write(vesicles_);
  EXPECT_TRUE(testing::names(checked().output, "snapshot_002.csv:9: column 'c': -9999"));
  EXPECT_TRUE(refuses(testing::traceraft(command(13)), "snapshot_002.csv:9: column 'c': -9999"));
}

// A picture without a vesicle in it, one of the other phase, and one that is not there.
TEST_F(ExplainRefusalTest, SaysWhichSnapshotIsNone) {
  snapshot(2).values.setConstant(0.25);
  write(vesicles_);
  EXPECT_TRUE(refuses(testing::traceraft(command(13)), "snapshot_003.csv: c is 0.25"));
  fs::remove(folder.path / "data" / "snapshot_003.csv");
  EXPECT_TRUE(refuses(testing::traceraft(command(13)), "snapshot_003.csv"));
}

TEST_F(ExplainRefusalTest, SaysThatCMayMarkTheOtherPhase) {
  asked_.raft_fraction = 0.35;
  vesicles_ = selection::draw_blind_case(asked_).vesicles;
  write(vesicles_);
  double mean = 0;
  for (const assimilation::FieldSnapshot& snapshot : vesicles_[0].snapshots)
    mean += snapshot.values.mean() / static_cast<double>(vesicles_[0].snapshots.size());
  EXPECT_TRUE(refuses(
      testing::traceraft(command(13) + " --raft-fraction " + format_number(1 - mean)), "1 - c"));
}

}  // namespace
}  // namespace traceraft
