// `traceraft data` from files to files.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "drivers/input/dataset.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::names;
using testing::ProgramEnd;
using testing::refuses;
using testing::traceraft;

const std::string kFacts = TRACERAFT_ROOT "/verification/data/published/guv-3to1.toml";

TEST(DataTest, DrawsWhatWasPublishedAndChecksIt) {
  const testing::TemporaryFolder folder;
  const std::string drawn = (folder.path / "drawn").string(),
                    again = (folder.path / "again").string(),
                    other = (folder.path / "other").string();
  ASSERT_EQ(traceraft("data draw " + drawn + " --facts " + kFacts).code, 0);
  ASSERT_EQ(traceraft("data draw " + again + " --facts " + kFacts + " --seed 1").code, 0);
  ASSERT_EQ(traceraft("data draw " + other + " --facts " + kFacts + " --seed 2").code, 0);
  const std::string table = content(folder.path / "drawn/measurements.csv");
  EXPECT_EQ(table, content(folder.path / "again/measurements.csv"));
  EXPECT_NE(table, content(folder.path / "other/measurements.csv"));
  EXPECT_EQ(table.rfind("# SYNTHETIC", 0), 0u);
  const ProgramEnd check = traceraft("data check " + drawn);
  ASSERT_EQ(check.code, 0);
  for (const char* fact : {"SYNTHETIC", "17 vesicles", "62 measurements", "100 to 1000 s"})
    EXPECT_TRUE(names(check.output, fact));
  // Nothing is drawn over what is there.
  EXPECT_EQ(traceraft("data draw " + drawn + " --facts " + kFacts).code, 2);
  EXPECT_EQ(content(folder.path / "drawn/measurements.csv"), table);
}

// Measurements after the end of the runs agree with nothing, rather than perfectly.
TEST(DataTest, ComparesNothingWithoutSayingSo) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"late\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
         "\"um\"\ntime_unit = \"h\"\nradius = 5\n";
  std::ofstream(folder.path / "measurements.csv") << "vesicle,time,rafts\na,10,1\nb,11,1\n";
  const ProgramEnd made =
      traceraft("data compare " + folder.path.string() +
                " --ensemble " TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1 --out " +
                (folder.path / "c").string());
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_TRUE(names(made.output, "NOTHING IS COMPARED"));
  EXPECT_TRUE(names(content(folder.path / "c/comparison.csv"), "rafts,0,2,0,,,,,\n"));
  // Nor do runs that end before others begin.
  fs::create_directories(folder.path / "kept");
  fs::copy_file(TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1/config.toml",
                folder.path / "kept/config.toml");
  std::ofstream(folder.path / "kept/histories.csv")
      << "seed,t,perimeter,rafts,fraction\n1,1,5,1,0.1\n1,2,5,1,0.1\n2,3,5,1,0.1\n2,4,5,1,0.1\n";
  const ProgramEnd apart =
      traceraft("data compare " + folder.path.string() + " --ensemble " +
                (folder.path / "kept").string() + " --out " + (folder.path / "d").string());
  EXPECT_TRUE(refuses(apart, "times in common"));
}

// In the unit of the file, beside what it says already.
TEST(DataTest, SaysWhichOffsetWouldRemoveATrend) {
  const testing::TemporaryFolder folder;
  const observations::MeasuredVesicles kept =
      input::read_dataset(TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1");
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"late\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
         "\"um\"\ntime_unit = \"min\"\ntime_offset = -0.5\n";
  std::ofstream table(folder.path / "measurements.csv");
  table << "vesicle,time,radius,perimeter,rafts\n";
  for (const observations::Measurement& m : kept.measurements)
    table << m.vesicle << "," << m.time / 60 + 0.5 << "," << m.radius << ","
          << *m.of(observations::Quantity::perimeter) * m.radius << ","
          << *m.of(observations::Quantity::rafts) << "\n";
  table.close();
  const ProgramEnd compared =
      traceraft("data compare " + folder.path.string() +
                " --ensemble " TRACERAFT_ROOT "/verification/data/ensembles/guv-3to1 --out " +
                (folder.path / "c").string());
  const std::string words = "time_offset = ";
  const std::size_t at = compared.output.find(words);
  ASSERT_NE(at, std::string::npos) << compared.output;
  // An onset after 97 s or so (docs/results.md).
  EXPECT_NEAR(std::stod(compared.output.substr(at + words.size())), -0.5 - 97 / 60.0, 0.2);
}

TEST(DataTest, RefusesWhatWouldDoNothing) {
  EXPECT_TRUE(refuses(
      traceraft("data check " TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1 --seed 3"),
      "--seed"));
}

// An exponential is a power law whose origin is infinitely early.
TEST(DataTest, SaysWhereIntervalsOfALawAreOpen) {
  const auto check = [](const std::function<double(double)>& perimeter) {
    const testing::TemporaryFolder folder;
    std::ofstream(folder.path / "dataset.toml")
        << "name = \"law\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
           "\"um\"\ntime_unit = \"s\"\nradius = 5\n";
    std::ofstream table(folder.path / "measurements.csv");
    table << "vesicle,time,perimeter\n";
    for (int k = 0; k < 5; ++k)
      for (double t = 100 + 20 * k; t < 1000; t += 150)
        table << "v" << k << "," << t << "," << 5 * perimeter(t) << "\n";
    table.close();
    return traceraft("data check " + folder.path.string()).output;
  };
  // The interval of the origin is that of a number, or goes to where it is no longer looked for.
  const std::string open = " (to ";
  EXPECT_TRUE(names(check([](double t) { return 10 * std::exp(-t / 500); }), open));
  EXPECT_FALSE(names(check([](double t) { return 10 * std::pow(t, -0.3); }), open));
}

// The same command for both kinds of measurements.
TEST(DataTest, ChecksMeasuredFields) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"half\"\nlength_unit = \"um\"\ntime_unit = \"min\"\nradius = 4\ntimes = [1, 2]\n";
  for (const int snapshot : {1, 2}) {
    std::ofstream table(folder.path / ("snapshot_00" + std::to_string(snapshot) + ".csv"));
    table << "x,y,z,c\n";
    for (int k = 0; k < 200; ++k) {  // a microscope may see no more than half of a vesicle
      const double z = (k + 0.5) / 200, angle = 2.4 * k, r = std::sqrt(1 - z * z);
      table << 4 * r * std::cos(angle) << "," << 4 * r * std::sin(angle) << "," << 4 * z << ","
            << k % 2 << "\n";
    }
  }
  const ProgramEnd check = traceraft("data check " + folder.path.string());
  ASSERT_EQ(check.code, 0) << check.output;
  // Eight of the icosahedron's corners have z >= 0.
  for (const char* fact : {"half", "R = 4 um", "120", "200", " 8 "})
    EXPECT_TRUE(names(check.output, fact));
  std::ofstream(folder.path / "snapshot_002.csv") << "x,y,z,c\n1,2,3,0.5\n";
  EXPECT_TRUE(refuses(traceraft("data check " + folder.path.string()), "snapshot_002.csv: 1 "));
}

TEST(DataTest, SaysWhereATableIsWrong) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"few\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
         "\"um\"\ntime_unit = \"s\"\n";
  std::ofstream(folder.path / "measurements.csv")
      << "vesicle,time,radius,perimeter\na,10,5,30\na,20,five,28\n";
  const ProgramEnd check = traceraft("data check " + folder.path.string());
  for (const char* fact : {"measurements.csv:3", "radius"}) EXPECT_TRUE(refuses(check, fact));
  EXPECT_EQ(traceraft("data chek " + folder.path.string()).code, 2);
}

}  // namespace
}  // namespace traceraft
