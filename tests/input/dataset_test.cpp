// Measured data from files: units, caps, and one line for everything that is wrong.
#include "drivers/input/dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "drivers/input/facts_file.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/types.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft::input {
namespace {

constexpr char kDescription[] =
    "name = \"mine\"\nkind = \"measured\"\ntime_zero = \"cooled\"\nlength_unit = \"nm\"\n"
    "time_unit = \"min\"\n";

class DatasetTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  observations::MeasuredVesicles read(const std::string& csv, const std::string& more = "") const {
    std::ofstream(folder.path / "dataset.toml") << kDescription << more;
    std::ofstream(folder.path / "measurements.csv") << csv;
    return read_dataset(folder.path);
  }
  void expect_complaint(const std::string& csv, const std::string& words,
                        const std::string& more = "") const {
    try {
      (void)read(csv, more);
      ADD_FAILURE() << "accepted: " << csv << more;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
};

TEST_F(DatasetTest, ConvertsUnits) {
  const observations::MeasuredVesicles data = read(
      "vesicle,time,radius,perimeter,perimeter_sigma,rafts,fraction\n"
      "a,1,5000,20000,1000,3,0.1\na,2,5000,,,2,\nb,1,4000,8000,,,\n");
  ASSERT_EQ(data.measurements.size(), 3u);
  const observations::Measurement& m = data.measurements[0];
  EXPECT_DOUBLE_EQ(m.time, 60);
  EXPECT_DOUBLE_EQ(m.radius, 5);
  EXPECT_DOUBLE_EQ(*m.of(observations::Quantity::perimeter), 4);
  EXPECT_DOUBLE_EQ(m.sigma_of(observations::Quantity::perimeter), 0.2);
  EXPECT_DOUBLE_EQ(*m.of(observations::Quantity::rafts), 3);
  EXPECT_FALSE(data.measurements[1].of(observations::Quantity::perimeter));
  EXPECT_EQ(data.vesicles().size(), 2u);
  const observations::MeasuredVesicles later =
      read("vesicle,time,rafts\na,1,2\n", "radius = 5000\ntime_offset = 0.5\n");
  EXPECT_DOUBLE_EQ(later.measurements[0].time, 90);
  EXPECT_DOUBLE_EQ(later.measurements[0].radius, 5);
  EXPECT_EQ(later.time_unit, 60);
  EXPECT_EQ(later.time_offset, 0.5);
  // A cap as large as the vesicle, in units that 5 um is no double of.
  EXPECT_EQ(read("vesicle,time,radius,cap_radius\na,1,8190,8190\n").measurements.size(), 1u);
}

TEST_F(DatasetTest, ComputesRaftsFromCaps) {
  const observations::MeasuredVesicles data =
      read("vesicle,time,radius,cap_radius\na,1,5000,3000\na,1,5000,4000\na,2,5000,5000\n");
  ASSERT_EQ(data.measurements.size(), 2u);
  const observations::Measurement& two = data.measurements[0];
  EXPECT_DOUBLE_EQ(*two.of(observations::Quantity::rafts), 2);
  EXPECT_NEAR(*two.of(observations::Quantity::perimeter), 2 * kPi * 1.4, 1e-12);
  // 1 − cos θ is 1/5 and 2/5 for sin θ of 3/5 and 4/5.
  EXPECT_NEAR(*two.of(observations::Quantity::fraction), 0.3, 1e-12);
  EXPECT_NEAR(*data.measurements[1].of(observations::Quantity::fraction), 0.5, 1e-12);
  const observations::MeasuredVesicles none =
      read("vesicle,time,radius,cap_radius\na,1,5000,\na,2,5000,100\n");
  EXPECT_EQ(*none.measurements[0].of(observations::Quantity::rafts), 0);
  EXPECT_EQ(*none.measurements[0].of(observations::Quantity::fraction), 0);
  EXPECT_EQ(*none.measurements[1].of(observations::Quantity::rafts), 1);
}

TEST_F(DatasetTest, ComputesSigmasFromThoseOfCaps) {
  const std::string heading = "vesicle,time,radius,cap_radius,cap_radius_sigma\n";
  const observations::MeasuredVesicles data =
      read(heading + "a,1,5000,3000,5\na,1,5000,4000,12\na,2,5000,5000,300\na,3,5000,1000,\n");
  const observations::Measurement& two = data.measurements[0];
  EXPECT_NEAR(two.sigma_of(observations::Quantity::perimeter), 2 * kPi * 13 / 5000, 1e-12);
  // df/da = tan θ/(2 r) for each cap.
  EXPECT_NEAR(two.sigma_of(observations::Quantity::fraction),
              std::hypot(0.75 * 5, 4.0 / 3 * 12) / (2 * 5000), 1e-6);
  EXPECT_FALSE(two.sigma[static_cast<std::size_t>(observations::Quantity::rafts)]);
  // A cap that is half of the sphere can only be meant to be smaller: cos θ = 0.34 for 300 less.
  EXPECT_NEAR(data.measurements[1].sigma_of(observations::Quantity::fraction),
              std::sqrt(1 - 0.94 * 0.94) / 2, 1e-12);
  EXPECT_FALSE(data.measurements[2].sigma[0]);
  const observations::MeasuredVesicles halves =
      read(heading + "a,1,5000,3000,9.79982\n", "sigma = \"95 % interval\"\n");
  EXPECT_NEAR(halves.measurements[0].sigma_of(observations::Quantity::perimeter), 2 * kPi * 0.001,
              1e-9);
  expect_complaint(heading + "a,1,5000,3000,5\na,1,5000,4000,\n",
                   ":3: column 'cap_radius_sigma': within one observation, all rafts");
  expect_complaint(heading + "a,1,5000,3000,-1\n", "column 'cap_radius_sigma': -1 is impossible");
}

TEST_F(DatasetTest, NamesFileLineAndColumn) {
  const std::string heading = "vesicle,time,radius,perimeter,rafts,fraction\n";
  expect_complaint(heading + "a,2,5000,20000,1,0.1\na,1,5000,20000,1,0.1\n",
                   "measurements.csv:3: column 'time': times of a vesicle must ascend");
  expect_complaint(heading + "a,1,5000,1,1,1.2\n", "column 'fraction': 1.2 is impossible");
  expect_complaint(heading + "a,1,5000,1,1.5,0.2\n", "column 'rafts': a whole number");
  expect_complaint(heading + "a,1,5,1,1,0.2\n", "is length_unit right?");
  expect_complaint(heading + "a,1,5000,,,\n", ":2: nothing was measured");
  expect_complaint(heading + "a,-1,5000,1,1,0.2\n", "before time zero");
  expect_complaint(heading + "a,x,5000,1,1,0.2\n", ":2: column 'time': 'x' is not a finite number");
  expect_complaint(heading + "a,1,5000,,1,0.1\nb,1,5000,,1,0.1\na,2,5000,,1,0.1\n",
                   ":4: column 'vesicle': vesicle 'a' occurs twice");
  expect_complaint(heading, "nothing was measured");
  expect_complaint("vesicle,radius,rafts\na,5000,1\n",
                   "measurements.csv:1: there is no column 'time'");
  expect_complaint("\n# mine\nvesicle,time,rafts\na,1,1\n", ":3: there is no column 'radius'");
  expect_complaint("vesicle,time,rafts\na,1,1\n", "dataset.toml:6: radius: a vesicle",
                   "radius = 5\n");
  expect_complaint(heading + "a,1,5000,5000001,1,0.1\n",
                   "5000001 is impossible (allowed: 0 to 5e+06)");
  for (const char* rows : {"a,1,5000,10\na,1,5000,\n", "a,1,5000,\na,1,5000,10\n"})
    expect_complaint(std::string("vesicle,time,radius,cap_radius\n") + rows,
                     ":3: column 'cap_radius': an observation without rafts has one row");
  expect_complaint("vesicle,time,radius,cap_radius\na,1,5000,0\n", "a raft has a size");
  expect_complaint("vesicle,time,raft\na,1,1\n", "did you mean 'rafts'");
  expect_complaint("vesicle,time,radius,cap_radius\na,1,5000,5001\n",
                   "column 'cap_radius': 5001 is impossible");
  expect_complaint("vesicle,time,radius,cap_radius\na,1,5000,5000\na,1,5000,5000\na,1,5000,1\n",
                   ":2: column 'cap_radius': the caps of this observation cover more");
  expect_complaint(heading + "a,1,5000,20000,1,0.1\n",
                   "dataset.toml:6: radius: ", "radius = 5000\n");
  expect_complaint(heading + "a,1,5000,20000,1,0.1\n",
                   "has a column 'radius'; leave one of the two out", "radius = 5000\n");
  expect_complaint("vesicle,time,rafts\na,1,1\n", "unknown key 'radiu'", "radiu = 3\n");
  expect_complaint("vesicle,time,rafts\na,1,1\n", "dataset.toml:6: sigma", "sigma = \"?\"\n");
}

TEST_F(DatasetTest, RefusesWhatContradictsItself) {
  const std::string heading = "vesicle,time,radius,perimeter,rafts,fraction\n";
  expect_complaint(heading + "a,1,5000,20000,0,\n", "column 'perimeter': without rafts");
  expect_complaint(heading + "a,1,5000,20000,,0\n", "column 'fraction': rafts have a boundary");
  expect_complaint(heading + "a,1,5000,,3,0\n", "column 'fraction': rafts have a boundary");
  // The shortest boundary of half of a sphere of 5 um is a great circle of 31.4 um.
  expect_complaint(heading + "a,1,5000,15000,1,0.5\n",
                   ":2: column 'perimeter': 15 um is too short: the shortest boundary of a raft "
                   "fraction of 0.5 has 31.4");
  EXPECT_EQ(read(heading + "a,1,5000,25000,1,0.5\n").measurements.size(), 1u);  // read off an image
  expect_complaint(heading + "a,1,5000,20000,1,0.1\na,2,8000,20000,1,0.05\n",
                   ":3: column 'radius': vesicle 'a' had a radius of 5 um");
  expect_complaint(heading + "a,1e300,5000,,1,\n", "is time_unit right?");
  expect_complaint("vesicle,time,radius,rafts,perimeter_sigma\na,1,5000,1,2\n",
                   ":1: there is a column 'perimeter_sigma', but none 'perimeter'");
  expect_complaint(heading + "a,1,5000,,1,\n#1,1,5000,,1,\n",
                   "measurements.csv:3: this comment has as many commas as a row");
  EXPECT_EQ(
      read("# one, two\n" + heading + "# a remark, short\na,1,5000,,1,\n").measurements.size(), 1u);
}

TEST_F(DatasetTest, ChecksMembraneAndTemperature) {
  const std::string rows = "vesicle,time,radius,rafts\na,1,5000,1\n";
  expect_complaint(rows, "dataset.toml:6: composition: 'banana' is not parts of DOPC",
                   "composition = \"banana\"\n");
  expect_complaint(rows, "dataset.toml:6: temperature: 288 degrees", "temperature = 288\n");
  expect_complaint(rows, "dataset.toml:6: temperature: nan degrees", "temperature = nan\n");
  EXPECT_EQ(read(rows, "composition = \"2:1:20 %\"\ntemperature = 19.2\n").celsius, 19.2);
}

TEST_F(DatasetTest, SaysWhatADescriptionLacks) {
  std::ofstream(folder.path / "dataset.toml") << "name = \"mine\"\n";
  EXPECT_THROW(
      try { (void)read_dataset(folder.path); } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("kind is missing"), std::string::npos);
        throw;
      },
      InputError);
  EXPECT_THROW((void)read_dataset(folder.path / "nowhere"), InputError);
}

TEST_F(DatasetTest, WhatIsDrawnFromFactsReadsBack) {
  const observations::PublishedFacts facts =
      read_facts(std::string(TRACERAFT_ROOT) + "/verification/data/published/guv-3to1.toml");
  EXPECT_EQ(facts.vesicles, 17);
  EXPECT_EQ(facts.measurements, 62);
  const observations::MeasuredVesicles drawn = observations::draw_measurements(facts, 5);
  write_dataset(folder.path / "drawn", drawn, "a test");
  const observations::MeasuredVesicles back = read_dataset(folder.path / "drawn");
  EXPECT_TRUE(back.synthetic);
  ASSERT_EQ(back.measurements.size(), drawn.measurements.size());
  for (std::size_t i = 0; i < drawn.measurements.size(); ++i) {
    EXPECT_DOUBLE_EQ(back.measurements[i].time, drawn.measurements[i].time);
    for (const observations::Quantity quantity : observations::kQuantities) {
      EXPECT_NEAR(*back.measurements[i].of(quantity), *drawn.measurements[i].of(quantity), 1e-12);
      EXPECT_NEAR(back.measurements[i].sigma_of(quantity), drawn.measurements[i].sigma_of(quantity),
                  1e-12);
    }
  }
}

// Vesicles that have lost their rafts show none, and no area of them.
TEST_F(DatasetTest, WhatIsDrawnFromRunsReadsBack) {
  const observations::PublishedFacts facts =
      read_facts(std::string(TRACERAFT_ROOT) + "/verification/data/published/guv-3to1.toml");
  const double later = 0.5 * facts.window.end;
  observations::History run;
  run.time = {1, later, facts.window.end};
  run.of(observations::Quantity::perimeter) = {10, 10, 10};
  run.of(observations::Quantity::rafts) = {3, 0, 0};
  run.of(observations::Quantity::fraction) = {0.1, 0.1, 0.1};
  write_dataset(folder.path / "drawn", observations::draw_from_runs(facts, {run, run, run}, 6, 5),
                "a test");
  int empty = 0;
  for (const observations::Measurement& m : read_dataset(folder.path / "drawn").measurements) {
    empty += *m.of(observations::Quantity::rafts) == 0;
    EXPECT_EQ(*m.of(observations::Quantity::fraction) == 0, m.time >= later);
  }
  EXPECT_GT(empty, 0);
}

// The sets that are kept are those that the program draws, and say what they are.
TEST_F(DatasetTest, KeptSyntheticSetsAreMarked) {
  for (const std::string name : {"guv-3to1", "guv-2to1"}) {
    const std::string data = std::string(TRACERAFT_ROOT) + "/verification/data/";
    const observations::MeasuredVesicles kept = read_dataset(data + "synthetic/" + name);
    EXPECT_TRUE(kept.synthetic);
    const observations::MeasuredVesicles drawn =
        observations::draw_measurements(read_facts(data + "published/" + name + ".toml"), 1);
    ASSERT_EQ(kept.measurements.size(), drawn.measurements.size());
    EXPECT_NE(kept.name.find("SYNTHETIC"), std::string::npos);
    for (std::size_t i = 0; i < kept.measurements.size(); ++i) {
      const observations::Measurement &one = kept.measurements[i], &other = drawn.measurements[i];
      EXPECT_NEAR(one.time, other.time, 1e-9);
      for (const observations::Quantity quantity : observations::kQuantities) {
        EXPECT_NEAR(*one.of(quantity), *other.of(quantity), 1e-9);
        EXPECT_NEAR(one.sigma_of(quantity), other.sigma_of(quantity), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace traceraft::input
