#include "drivers/input/field_dataset.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/input/dataset.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft::input {
namespace {

FieldDataset small_dataset() {
  FieldDataset data;
  data.name = "small";
  data.synthetic = true;
  data.radius_um = 5;
  assimilation::FieldSeries series{"1", {}};
  for (int k = 0; k < 3; ++k) {
    assimilation::FieldSnapshot snapshot{10.0 * k, {}, Vec(120), Vec::Ones(120)};
    for (int i = 0; i < 120; ++i) {
      const double angle = 0.1 * i;
      snapshot.points.emplace_back(std::cos(angle), std::sin(angle), 0);
      snapshot.values[i] = 0.01 * i + k;
      snapshot.deviation[i] = 0.1 + 0.001 * i;
    }
    series.snapshots.push_back(snapshot);
  }
  data.vesicles = {series};
  return data;
}

class FieldDatasetTest : public ::testing::Test {
 protected:
  FieldDatasetTest() { write_field_dataset(folder.path, small_dataset(), "of a test"); }

  void replace(const std::string& file, const std::string& text) const {
    std::ofstream(folder.path / file) << text;
  }
  std::string refusal() const {
    try {
      (void)read_field_dataset(folder.path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  void expect_refusal(const std::string& part) const {
    EXPECT_NE(refusal().find(part), std::string::npos) << refusal();
  }
  std::string description(const std::string& times) const {
    return "name = \"a\"\nlength_unit = \"um\"\ntime_unit = \"s\"\nradius = 5\ntimes = " + times +
           "\n";
  }

  testing::TemporaryFolder folder;
};

TEST_F(FieldDatasetTest, KeepsVesiclesTogether) {
  std::filesystem::copy(folder.path / "snapshot_001.csv", folder.path / "snapshot_004.csv");
  replace("dataset.toml", description("[1, 1, 2, 2]") + "vesicles = [1, 2, 1, 2]\n");
  expect_refusal("snapshots of vesicle 1 must follow each other");
}

TEST_F(FieldDatasetTest, ReadsWhatItHasWritten) {
  const FieldDataset data = read_field_dataset(folder.path);
  ASSERT_EQ(data.vesicles.size(), 1u);
  ASSERT_EQ(data.vesicles[0].snapshots.size(), 3u);
  EXPECT_TRUE(data.synthetic);
  const FieldDataset written = small_dataset();
  const assimilation::FieldSnapshot &before = written.vesicles[0].snapshots[2],
                                    &after = data.vesicles[0].snapshots[2];
  EXPECT_EQ(after.time, before.time);
  EXPECT_LT((after.points[7] - before.points[7]).norm(), 1e-8);
  EXPECT_LT((after.values - before.values).norm(), 1e-4);
  EXPECT_LT((after.deviation - before.deviation).norm(), 1e-4);
}

TEST_F(FieldDatasetTest, ReadsWhatNeighboursShareOfTheNoise) {
  EXPECT_EQ(read_field_dataset(folder.path).noise_share, 0);
  FieldDataset data = small_dataset();
  data.noise_correlation_um = 0.25;
  data.noise_share = 0.2;
  write_field_dataset(folder.path, data, "of a test");
  EXPECT_EQ(read_field_dataset(folder.path).noise_share, 0.2);
  EXPECT_NEAR(read_field_dataset(folder.path).noise_correlation_um, 0.25, 1e-12);
  replace("dataset.toml", description("[1, 2, 3]") + "noise_share = 0.2\n");
  expect_refusal("it needs noise_correlation");
  replace("dataset.toml",
          description("[1, 2, 3]") + "noise_share = 1.2\nnoise_correlation = 0.1\n");
  expect_refusal("from 0 to 1");
  replace("dataset.toml", description("[1, 2, 3]") + "noise_share = 0.2\nnoise_correlation = 3\n");
  expect_refusal("0.14 of the radius");
}

TEST_F(FieldDatasetTest, AsksAboutARadiusThatThePointsContradict) {
  FieldDataset data = small_dataset();
  EXPECT_EQ(note_on_distance(data), "");
  data.vesicles[0].snapshots[0].points[3] *= 1.5;  // one that is off is another matter
  EXPECT_EQ(note_on_distance(data), "");
  for (assimilation::FieldSnapshot& snapshot : data.vesicles[0].snapshots)
    for (Point& x : snapshot.points) x *= 0.9;
  const std::string note = note_on_distance(data);
  EXPECT_NE(note.find("from the centre is 4.5 um"), std::string::npos) << note;
  EXPECT_NE(note.find("stated radius is 5 um"), std::string::npos) << note;
}

TEST_F(FieldDatasetTest, AsksAboutValuesOnAnotherScale) {
  FieldDataset data = small_dataset();
  for (assimilation::FieldSnapshot& snapshot : data.vesicles[0].snapshots)
    for (Eigen::Index i = 0; i < snapshot.values.size(); ++i) snapshot.values[i] = i % 2;
  const auto scale = [&](double factor, double zero) {
    for (assimilation::FieldSnapshot& snapshot : data.vesicles[0].snapshots)
      snapshot.values = (factor * snapshot.values.array() + zero).matrix();
  };
  EXPECT_EQ(note_on_scale(data, 0, 1), "");
  scale(2, 1);
  EXPECT_NE(note_on_scale(data, 0, 1).find("Is c on this scale?"), std::string::npos);
  EXPECT_EQ(note_on_scale(data, 1, 3), "");
}

TEST_F(FieldDatasetTest, KnowsSeriesFromFields) {
  std::filesystem::remove(folder.path / "snapshot_001.csv");
  replace("measurements.csv", "vesicle,time\n");
  expect_refusal("not fields");
}

// One description for both; what is added to times is added to all of them.
TEST_F(FieldDatasetTest, ReadsAFolderOfBothKinds) {
  EXPECT_FALSE(holds_series(folder.path));
  replace("dataset.toml",
          "name = \"a\"\nkind = \"synthetic\"\ntime_zero = \"t\"\nlength_unit = \"um\"\n"
          "time_unit = \"min\"\nradius = 5\ntime_offset = 0.5\ntimes = [1, 2, 3]\n"
          "table = \"sheet.csv\"\nblur = 0.1\n");
  replace("sheet.csv", "vesicle,time,rafts\na,1,2\n");
  EXPECT_TRUE(holds_series(folder.path));
  EXPECT_TRUE(holds_fields(folder.path));
  EXPECT_EQ(read_field_dataset(folder.path).vesicles[0].snapshots[1].time, 150);
  const observations::Measurement look = read_dataset(folder.path).measurements.at(0);
  EXPECT_EQ(look.time, 90);
  EXPECT_EQ(look.radius, 5);
}

TEST_F(FieldDatasetTest, ConvertsUnits) {
  FieldDataset large = small_dataset();
  large.radius_um = 500;
  write_field_dataset(folder.path, large, "of a test");
  replace("dataset.toml",
          "name = \"a\"\nlength_unit = \"nm\"\ntime_unit = \"min\"\nradius = 500\n"
          "times = [1, 2, 3]\n");
  const FieldDataset data = read_field_dataset(folder.path);
  EXPECT_DOUBLE_EQ(data.radius_um, 0.5);
  EXPECT_DOUBLE_EQ(data.vesicles[0].snapshots[1].time, 120);
}

TEST_F(FieldDatasetTest, RefusesWhatIsWrongWithItsPlace) {
  replace("dataset.toml", description("[10, 5]"));
  expect_refusal("dataset.toml:5: times");
  for (const auto& [line, complaint] :
       {std::pair("temperature = 288", "dataset.toml:6: temperature: 288 degrees"),
        std::pair("composition = \"banana\"", "'banana' is not parts of DOPC")}) {
    replace("dataset.toml", description("[1, 2, 3]") + line + "\n");
    expect_refusal(complaint);
  }
  replace("dataset.toml", description("[1, inf]"));
  expect_refusal("dataset.toml:5: times: inf s is impossible");
  replace("dataset.toml",
          "name = \"a\"\nlength_unit = \"um\"\ntime_unit = \"s\"\nradius = inf\n"
          "times = [1, 2, 3]\n");
  expect_refusal("dataset.toml:4: radius: a vesicle of radius inf um is impossible");
  replace("dataset.toml", description("[10]"));
  expect_refusal("two snapshots or more");
  replace("dataset.toml", description("[1, 2]"));
  expect_refusal("2 times, but there is snapshot_003.csv");
  replace("dataset.toml", description("[1, 2, 3]") + "kind = \"real\"\n");
  expect_refusal("'real' is neither measured nor synthetic");
  replace("dataset.toml", description("[1, 2]"));
  replace("snapshot_002.csv", "x,y,z\n1,0,0\n");
  expect_refusal("snapshot_002.csv");
  std::string rows = "x,y,z,c,sigma\n";
  for (int i = 0; i < 120; ++i) rows += i == 4 ? "5,0,0,0.1,0\n" : "5,0,0,0.1,1\n";
  replace("snapshot_002.csv", rows);
  expect_refusal("snapshot_002.csv:6: column 'sigma'");
}

}  // namespace
}  // namespace traceraft::input
