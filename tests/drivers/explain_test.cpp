// `traceraft explain` as its user runs it, on measurements whose truth it is not told.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/field_dataset.hpp"
#include "kernel/physics/units.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "verification/explain/blind/blind_case.hpp"
#include "verification/measure/bench.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

class ExplainTest : public ::testing::Test {
 protected:
  // What a vesicle of 5 µm with ε = 0.75 µm and D = 1e-5 cm²/s would show.
  BlindRequest request() const {
    BlindRequest request;
    request.base = bench_model("degenerate", 0.15);
    request.cells = 24;
    request.first = 30;
    request.last = 140;
    request.snapshots = 5;
    request.points = 1200;
    request.seed = 2;
    return request;
  }
  BlindCase draw(const std::string& effect, double gap = BlindRequest{}.gap) const {
    BlindRequest asked = request();
    asked.gap = gap;
    if (!effect.empty()) asked.effects = {effect};
    BlindCase drawn = draw_blind_case(asked);
    write(drawn.vesicles);
    return drawn;
  }
  void write(std::vector<FieldSeries> vesicles) const {
    FieldDataset data;
    data.name = "drawn";
    data.synthetic = true;
    data.radius_um = 5;
    data.blur_um = 0;
    data.vesicles = std::move(vesicles);
    for (FieldSeries& vesicle : data.vesicles)
      for (FieldSnapshot& snapshot : vesicle.snapshots) snapshot.time *= Units().time();
    write_field_dataset(folder.path / "data", data, "drawn by a test");
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
  nlohmann::json verdict() const {
    return nlohmann::json::parse(testing::content(folder.path / "out" / "verdict.json"));
  }
  nlohmann::json explain(int cells = 15) const {
    const auto end = testing::traceraft(command(cells));
    EXPECT_EQ(end.code, 0) << end.output;
    return verdict();
  }
  testing::TemporaryFolder folder;
  int threads = 1;
};

TEST_F(ExplainTest, NamesWhatWasHidden) {
  // Strong enough for its gap to be told to a tenth from the noise of so few values.
  const BlindCase drawn = draw("uptake", 0.1);
  const nlohmann::json verdict = explain();
  EXPECT_EQ(verdict["effect"], "uptake") << verdict.dump(2);
  const nlohmann::json& rate = verdict["parameters"]["uptake.rate"];
  const double truth = drawn.truth[0].values[0] / Units().time();
  EXPECT_NEAR(rate["value"], truth, 4 * rate["sigma"].get<double>());
  EXPECT_LT(rate["sigma"], 0.2 * truth);
  EXPECT_NEAR(verdict["noise"]["level"], drawn.noise, 0.05 * drawn.noise);
  // What is left is what is to be expected of noise.
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
  ASSERT_EQ(verdict["remarks"].size(), 1u) << verdict["remarks"];
  EXPECT_NE(verdict["remarks"][0].get<std::string>().find("D is between"), std::string::npos);
  // Within four standard deviations of a root mean square of the 1,200 values held out.
  EXPECT_NEAR(again["named"]["heldout"], again["floor"]["heldout"],
              4 / std::sqrt(2 * 1200.0) * gap("floor"));
  EXPECT_LT(verdict["bounds"]["bulk-mobility.strength"]["high"], 1);
  EXPECT_FALSE(verdict["bounds"].contains("uptake.rate"));
  const std::string page = testing::content(folder.path / "out" / "explain.html");
  EXPECT_NE(page.find("The model lacks uptake: "), std::string::npos) << verdict.dump(2);
  EXPECT_NE(page.find("Verdict: named (uptake)"), std::string::npos);
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
  BlindRequest asked = request();
  asked.effects = {"uptake"};
  asked.gap = 0.2;
  asked.points = 500;
  asked.last = 90;
  write(draw_blind_case(asked).vesicles);
  const pid_t child = testing::start_traceraft(command_of_few(kCells));
  const fs::path saved = folder.path / "out" / "search.json";
  const auto has_a_refit = [&] {
    return fs::exists(saved) && testing::content(saved).find("\"ahead\":{\"") != std::string::npos;
  };
  while (!has_a_refit() && waitpid(child, nullptr, WNOHANG) == 0) usleep(20000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(has_a_refit());
  threads = 2;  // which makes no difference
  const auto end = testing::traceraft(command_of_few(kCells));
  threads = 1;
  ASSERT_EQ(end.code, 0) << end.output;
  EXPECT_NE(end.output.find("continue from the saved state"), std::string::npos) << end.output;
  EXPECT_EQ(end.output.find("pace of the base model"), std::string::npos) << end.output;
  EXPECT_NE(end.output.find("check on another mesh"), std::string::npos) << end.output;
  const nlohmann::json resumed = verdict();
  // A search that is over is only told again.
  const auto again = testing::traceraft(command_of_few(kCells));
  EXPECT_EQ(again.output.find("check on another mesh"), std::string::npos) << again.output;
  EXPECT_EQ(verdict(), resumed);
  fs::remove_all(folder.path / "out");
  ASSERT_EQ(testing::traceraft(command_of_few(kCells)).code, 0);
  const nlohmann::json whole = verdict();
  EXPECT_EQ(whole["effect"], "uptake");
  EXPECT_EQ(resumed.dump(2), whole.dump(2));
  // Another search does not take its place.
  for (const auto& [changed, what] :
       {std::pair(command_of_few(kCells, ",gravity"), "--without;"),
        std::pair(command_of_few(kCells, "", 59), "--replicates;"),
        std::pair(command_of_few(kCells) + " --diffusion-error 0.1", "--diffusion-error;")}) {
    const auto other = testing::traceraft(changed);
    EXPECT_EQ(other.code, 2) << changed;
    EXPECT_NE(other.output.find(std::string("holds a search that differs in ") + what),
              std::string::npos)
        << other.output;
  }
}

// Vesicles with few snapshots tell together what one of them tells with more.
TEST_F(ExplainTest, JoinsWhatVesiclesSay) {
  BlindRequest asked = request();
  asked.effects = {"uptake"};
  asked.vesicles = 2;
  asked.snapshots = 3;
  asked.points = 1000;
  const BlindCase drawn = draw_blind_case(asked);
  ASSERT_EQ(drawn.vesicles.size(), 2u);
  EXPECT_NE(drawn.vesicles[0].snapshots[0].values[0], drawn.vesicles[1].snapshots[0].values[0]);
  write(drawn.vesicles);
  ASSERT_EQ(testing::traceraft(command_of_few(11)).code, 0);
  const nlohmann::json found = verdict();
  EXPECT_EQ(found["effect"], "uptake") << found.dump(2);
  const nlohmann::json& rate = found["parameters"]["uptake.rate"];
  EXPECT_NEAR(rate["value"], drawn.truth[0].values[0] / Units().time(),
              4 * rate["sigma"].get<double>());

  // The model that has what was found lacks nothing; its rate is fitted once more.
  const std::string out = (folder.path / "again").string();
  const auto again = testing::traceraft("explain --data " + (folder.path / "data").string() +
                                        " --model " + (folder.path / "out/model.toml").string() +
                                        few + " --threads 1 --replicates 49 --out " + out);
  ASSERT_EQ(again.code, 0) << again.output;
  const auto whole = nlohmann::json::parse(testing::content(out + "/verdict.json"));
  EXPECT_EQ(whole["verdict"], "none") << whole.dump(2);
  EXPECT_TRUE(whole["effect"].is_null());
  const nlohmann::json& same = whole["parameters"]["uptake.rate"];
  EXPECT_NEAR(same["value"], rate["value"].get<double>(), 0.2 * rate["sigma"].get<double>());
  EXPECT_NEAR(same["sigma"], rate["sigma"].get<double>(), 0.5 * rate["sigma"].get<double>());
  EXPECT_FALSE(whole["bounds"].contains("uptake.rate"));
  EXPECT_EQ(std::count(whole["not_looked_for"].begin(), whole["not_looked_for"].end(), "uptake"),
            0);
  EXPECT_NE(whole["model"]["effect"].get<std::string>().find("uptake:rate="), std::string::npos);
}

TEST_F(ExplainTest, SaysWhatIsOddAboutTheData) {
  BlindRequest asked = request();
  asked.snapshots = 4;
  asked.points = 600;
  asked.last = 90;
  std::vector<FieldSeries> vesicles = draw_blind_case(asked).vesicles;
  std::vector<FieldSnapshot>& snapshots = vesicles[0].snapshots;
  for (Point& x : snapshots[2].points)
    x = Point(std::cos(0.3) * x[0] - std::sin(0.3) * x[1],
              std::sin(0.3) * x[0] + std::cos(0.3) * x[1], x[2]);
  for (int k = 0; k < 5; ++k) snapshots[1].values[100 * k] = 4;
  vesicles[0].vesicle = "7";
  write(vesicles);
  const auto end = testing::traceraft(command_of_few(10));
  ASSERT_EQ(end.code, 0) << end.output;
  const std::string remarks = verdict()["remarks"].dump();
  EXPECT_NE(remarks.find("5 values were left out"), std::string::npos) << remarks;
  // Turned before the third snapshot, and back before the fourth.
  EXPECT_NE(remarks.find("rad before snapshot 3, 0."), std::string::npos) << remarks;
  EXPECT_NE(remarks.find("rad before snapshot 4"), std::string::npos) << remarks;
  EXPECT_EQ(remarks.find("seems to be rotated"), std::string::npos) << remarks;
}

TEST_F(ExplainTest, RefusesWhatItCannotUse) {
  const std::string data = " --data " + (folder.path / "data").string();
  const auto refusal = [](const std::string& command) {
    const auto end = testing::traceraft(command);
    EXPECT_EQ(end.code, 2) << end.output;
    return end.output;
  };
  refusal("explain");
  EXPECT_NE(refusal("explain" + data).find("dataset.toml"), std::string::npos);
  fs::create_directories(folder.path / "mine");
  write_durably(folder.path / "mine" / "notes.txt", "mine");

  BlindRequest asked = request();
  asked.snapshots = 3;
  asked.points = 150;
  std::vector<FieldSeries> vesicles = draw_blind_case(asked).vesicles;
  write(vesicles);
  EXPECT_NE(refusal("explain" + data).find("--case or --model"), std::string::npos);
  EXPECT_NE(refusal("explain" + data + " --epsilon 0.75 --cells 13 --out " +
                    (folder.path / "mine").string())
                .find("holds notes.txt"),
            std::string::npos);
  // What was found would take the place of the model that it was given.
  fs::create_directories(folder.path / "out");
  write_durably(folder.path / "out" / "model.toml", "epsilon = 0.75\ncells = 13\n");
  const std::string own = (folder.path / "out" / "model.toml").string();
  EXPECT_NE(
      refusal("explain" + data + " --model " + own + " --out " + (folder.path / "out").string())
          .find("holds the model"),
      std::string::npos);
  fs::remove(own);
  EXPECT_NE(refusal(command(13) + " --effect thermal:strength=0.1,time=1").find("cannot be fitted"),
            std::string::npos);
  EXPECT_NE(refusal(command(13) + " --effect curvature:strength=0.1").find("on this surface"),
            std::string::npos);
  // On a sphere there is no other one than curvature.
  std::string text = refusal(command(13) +
                             " --without allen-cahn,asymmetry,bulk-mobility,cooling,"
                             "exchange,gravity,line-tension,mobility-contrast,mobility-exponent,"
                             "ohta-kawasaki,uptake");
  EXPECT_NE(text.find("--without: no effect is left to search for"), std::string::npos) << text;
  const auto checked = [&] {
    const auto end = testing::traceraft("data check " + (folder.path / "data").string());
    EXPECT_EQ(end.code, 0) << end.output;
    return end.output;
  };
  EXPECT_EQ(checked().find("NOTE"), std::string::npos);
  vesicles[0].snapshots[1].points[7] *= 1.3;
  write(vesicles);
  text = checked();
  EXPECT_NE(
      text.find(
          "snapshot_002.csv:9: the distance of a point from the sphere of this radius is 0.3 R"),
      std::string::npos)
      << text;
  text = refusal(command(13));
  EXPECT_NE(text.find("snapshot_002.csv:9: ("), std::string::npos) << text;
  vesicles[0].snapshots[1].points[7] /= 1.3;
  vesicles[0].snapshots[1].values[7] = -9999;
  write(vesicles);
  text = refusal(command(13));
  EXPECT_NE(text.find("snapshot_002.csv:9: column 'c': -9999"), std::string::npos) << text;
  text = checked();
  EXPECT_NE(text.find("snapshot_002.csv:9: column 'c': -9999; explain"), std::string::npos) << text;
  // A picture without a vesicle in it, and one of the other phase.
  const std::vector<FieldSeries> good = draw_blind_case(asked).vesicles;
  vesicles = good;
  vesicles[0].snapshots[2].values.setConstant(0.25);
  write(vesicles);
  EXPECT_NE(refusal(command(13)).find("snapshot_003.csv: c is 0.25 everywhere"), std::string::npos);
  asked.raft_fraction = 0.35;
  vesicles = draw_blind_case(asked).vesicles;
  write(vesicles);
  double mean = 0;
  for (const FieldSnapshot& snapshot : vesicles[0].snapshots)
    mean += snapshot.values.mean() / static_cast<double>(vesicles[0].snapshots.size());
  text = refusal(command(13) + " --raft-fraction " + format_number(1 - mean));
  EXPECT_NE(text.find("if c marks the other phase, write 1 - c"), std::string::npos) << text;
  fs::remove(folder.path / "data" / "snapshot_003.csv");
  text = refusal(command(13));
  EXPECT_NE(text.find("3 times, but there is no snapshot_003.csv"), std::string::npos) << text;
}

// Coarse, and with a raft that is one from the start, which no measured vesicle is.
TEST(ExplainSeriesTest, SimulatesOnceAndSaysWhatSeriesTell) {
  const testing::TemporaryFolder folder;
  const fs::path model = folder.path / "model.toml", out = folder.path / "out";
  write_durably(model, "epsilon = 0.8\ncells = 16\nraft-fraction = 0.3\n");
  const std::string command =
      "explain --data " TRACERAFT_ROOT
      "/verification/data/synthetic/guv-3to1 --runs 3 "
      "--replicates 49 --without allen-cahn,asymmetry,bulk-mobility,cooling,exchange,gravity,"
      "line-tension,mobility-contrast,mobility-exponent --out " +
      out.string() + " --model ";
  const auto end = testing::traceraft(command + model.string());
  ASSERT_EQ(end.code, 0) << end.output;
  EXPECT_NE(end.output.find("simulations with no effect"), std::string::npos) << end.output;
  EXPECT_NE(end.output.find("\nVerdict of the series: unnamed\n"), std::string::npos) << end.output;
  const auto series = nlohmann::json::parse(testing::content(out / "series.json"));
  EXPECT_EQ(series["verdict"], "unnamed") << series.dump(2);
  ASSERT_EQ(series["scores"].size(), 2u);
  EXPECT_EQ(series["vesicles"], 17);
  for (const auto& score : series["scores"])
    EXPECT_TRUE(score["vesicles_needed"].is_null() || score["vesicles_needed"] > 0) << score;
  EXPECT_EQ(series["exponents"][0]["model"], "synthetic data");
  EXPECT_NEAR(series["exponents"][0]["b"], -0.37, 0.1);  // as published
  const auto verdict = nlohmann::json::parse(testing::content(out / "verdict.json"));
  EXPECT_EQ(verdict["verdict"], "unnamed");
  EXPECT_EQ(verdict["alternatives"].size(), 2u);
  EXPECT_FALSE(fs::exists(out / "model.toml"));
  EXPECT_NE(testing::content(out / "series.html").find("SYNTHETIC"), std::string::npos);

  const fs::file_time_type before = fs::last_write_time(out / "ensembles/base/runs/seed-1");
  const fs::path plan = out / "ensembles/base/plan.json";
  const std::string planned_before = testing::content(plan);
  write_durably(plan, "{");  // which is written anew
  ASSERT_EQ(testing::traceraft(command + model.string()).code, 0);
  EXPECT_EQ(testing::content(plan), planned_before);
  EXPECT_EQ(fs::last_write_time(out / "ensembles/base/runs/seed-1"), before);

  // Other vesicles are held against the same simulations.
  const fs::path others = folder.path / "others", second = folder.path / "second";
  ASSERT_EQ(testing::traceraft("data draw " + others.string() +
                               " --seed 2 --facts " TRACERAFT_ROOT
                               "/verification/data/published/guv-3to1.toml")
                .code,
            0);
  const std::size_t without = command.find("--without"), end_of_without = command.find(" --out");
  const std::string of_others = "explain --series " + others.string() + " --replicates 49 --out " +
                                second.string() + " " +
                                command.substr(without, end_of_without - without) + " --model " +
                                model.string() + " --ensembles ";
  const auto nothing = testing::traceraft(of_others + others.string());
  EXPECT_EQ(nothing.code, 2);
  EXPECT_NE(nothing.output.find("--ensembles: "), std::string::npos) << nothing.output;
  EXPECT_FALSE(fs::exists(second));
  const auto planned = fs::last_write_time(plan);
  const auto compared = testing::traceraft(of_others + (out / "ensembles").string());
  ASSERT_EQ(compared.code, 0) << compared.output;
  EXPECT_NE(testing::content(second / "series.json"), testing::content(out / "series.json"));
  EXPECT_FALSE(fs::exists(second / "ensembles"));
  EXPECT_EQ(fs::last_write_time(plan), planned) << "others may read it";
  EXPECT_EQ(fs::last_write_time(out / "ensembles/base/runs/seed-1"), before);
  ASSERT_EQ(testing::traceraft(of_others + (out / "ensembles").string()).code, 0) << "once more";
  const auto older = nlohmann::json::parse(testing::content(out / "ensembles/strengths.json"));
  write_durably(
      out / "ensembles/strengths.json",
      nlohmann::json{{"identity", older["identity"]}, {"strengths", older["strengths"]}}.dump());
  const auto earlier = testing::traceraft(of_others + (out / "ensembles").string());
  EXPECT_EQ(earlier.code, 2);
  EXPECT_NE(earlier.output.find("by an earlier version"), std::string::npos) << earlier.output;
  nlohmann::json foreign = older;
  foreign["identity"] = "another";
  write_durably(out / "ensembles/strengths.json", foreign.dump());
  const fs::path third = folder.path / "third";
  const auto another = testing::traceraft("explain --series " + others.string() + " --out " +
                                          third.string() + " --model " + model.string() +
                                          " --ensembles " + (out / "ensembles").string());
  EXPECT_EQ(another.code, 2);
  EXPECT_NE(another.output.find("--ensembles: " + (out / "ensembles").string() +
                                " holds simulations of another model"),
            std::string::npos)
      << another.output;
  EXPECT_FALSE(fs::exists(third));
  write_durably(out / "ensembles/strengths.json", older.dump());

  const auto extended =
      testing::traceraft(command + model.string() + " --effect gravity:strength=0.1");
  EXPECT_EQ(extended.code, 2);
  EXPECT_NE(extended.output.find("a model without effects"), std::string::npos) << extended.output;

  const fs::path other = folder.path / "other.toml";
  write_durably(other, "epsilon = 0.8\ncells = 16\nraft-fraction = 0.4\n");
  const fs::path none = folder.path / "none";
  const std::string torus_model = "epsilon = 0.8\ncells = 16\nsurface = \"torus\"\n";
  write_durably(model, torus_model + "raft-fraction = 0.1\n");
  const auto torus = testing::traceraft("explain --series " TRACERAFT_ROOT
                                        "/verification/data/synthetic/guv-3to1 --model " +
                                        model.string() + " --out " + none.string());
  EXPECT_EQ(torus.code, 2);
  EXPECT_NE(torus.output.find("on spheres only"), std::string::npos) << torus.output;
  EXPECT_FALSE(fs::exists(none));
  // The raft fraction of a membrane that nobody has named.
  write_durably(model, torus_model);
  const auto unnamed = testing::traceraft("explain --series " TRACERAFT_ROOT
                                          "/verification/data/synthetic/guv-3to1 --model " +
                                          model.string() + " --out " + none.string());
  EXPECT_EQ(unnamed.code, 2);
  EXPECT_NE(unnamed.output.find("2:1:20 (case guv-2to1, by default)"), std::string::npos)
      << unnamed.output;

  const auto refused = testing::traceraft(command + other.string());
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.output.find("another model"), std::string::npos) << refused.output;
}

}  // namespace
}  // namespace traceraft
