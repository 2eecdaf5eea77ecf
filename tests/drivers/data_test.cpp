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
using testing::ProgramEnd;
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
  EXPECT_NE(check.output.find("SYNTHETIC: 17 vesicles, 62 measurements"), std::string::npos)
      << check.output;
  EXPECT_NE(check.output.find("power law from 100 to 1000 s"), std::string::npos);
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
  EXPECT_NE(made.output.find("NOTHING IS COMPARED"), std::string::npos) << made.output;
  EXPECT_NE(content(folder.path / "c/comparison.csv").find("rafts,0,2,0,,,,,\n"), std::string::npos)
      << content(folder.path / "c/comparison.csv");
  // Nor do runs that end before others begin.
  fs::create_directories(folder.path / "kept");
  fs::copy_file(TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1/config.toml",
                folder.path / "kept/config.toml");
  std::ofstream(folder.path / "kept/histories.csv")
      << "seed,t,perimeter,rafts,fraction\n1,1,5,1,0.1\n1,2,5,1,0.1\n2,3,5,1,0.1\n2,4,5,1,0.1\n";
  const ProgramEnd apart =
      traceraft("data compare " + folder.path.string() + " --ensemble " +
                (folder.path / "kept").string() + " --out " + (folder.path / "d").string());
  EXPECT_EQ(apart.code, 2);
  EXPECT_NE(apart.output.find("no times in common"), std::string::npos) << apart.output;
}

// In the unit of the file, beside what it says already.
TEST(DataTest, SaysWhichOffsetWouldRemoveATrend) {
  const testing::TemporaryFolder folder;
  const MeasuredVesicles kept =
      read_dataset(TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1");
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"late\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
         "\"um\"\ntime_unit = \"min\"\ntime_offset = -0.5\n";
  std::ofstream table(folder.path / "measurements.csv");
  table << "vesicle,time,radius,perimeter,rafts\n";
  for (const Measurement& m : kept.measurements)
    table << m.vesicle << "," << m.time / 60 + 0.5 << "," << m.radius << ","
          << *m.of(Quantity::perimeter) * m.radius << "," << *m.of(Quantity::rafts) << "\n";
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
  const ProgramEnd made =
      traceraft("data check " TRACERAFT_ROOT "/verification/data/synthetic/guv-3to1 --seed 3");
  EXPECT_EQ(made.code, 2);
  EXPECT_NE(made.output.find("--seed: data check does not use it"), std::string::npos)
      << made.output;
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
  const std::string remark = "Then b may be lower, and c larger";
  EXPECT_NE(check([](double t) { return 10 * std::exp(-t / 500); }).find(remark),
            std::string::npos);
  EXPECT_EQ(check([](double t) { return 10 * std::pow(t, -0.3); }).find(remark), std::string::npos);
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
  for (const char* part :
       {"half: measured fields of 1 vesicle, R = 4 um", "120", "200", "not stated"})
    EXPECT_NE(check.output.find(part), std::string::npos) << part << "\n" << check.output;
  // Of the icosahedron's corners eight have z >= 0.
  EXPECT_NE(check.output.find(" 8 "), std::string::npos) << check.output;
  std::ofstream(folder.path / "snapshot_002.csv") << "x,y,z,c\n1,2,3,0.5\n";
  const ProgramEnd few = traceraft("data check " + folder.path.string());
  EXPECT_EQ(few.code, 2);
  EXPECT_NE(few.output.find("snapshot_002.csv: 1 points are too few"), std::string::npos)
      << few.output;
}

TEST(DataTest, SaysWhereATableIsWrong) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path / "dataset.toml")
      << "name = \"few\"\nkind = \"measured\"\ntime_zero = \"start\"\nlength_unit = "
         "\"um\"\ntime_unit = \"s\"\n";
  std::ofstream(folder.path / "measurements.csv")
      << "vesicle,time,radius,perimeter\na,10,5,30\na,20,five,28\n";
  const ProgramEnd check = traceraft("data check " + folder.path.string());
  EXPECT_EQ(check.code, 2);
  EXPECT_NE(check.output.find("measurements.csv:3"), std::string::npos) << check.output;
  EXPECT_NE(check.output.find("radius"), std::string::npos) << check.output;
  EXPECT_EQ(traceraft("data chek " + folder.path.string()).code, 2);
}

}  // namespace
}  // namespace traceraft
