// Thousands of damaged inputs: each is read, or refused with a reason. What else goes wrong the
// sanitizers of continuous integration see.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "backends/muparser/formula.hpp"
#include "backends/zlib/vtu_reader.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/input/facts_file.hpp"
#include "drivers/input/field_dataset.hpp"
#include "drivers/input/json_members.hpp"
#include "drivers/text/encoders.hpp"
#include "drivers/text/utf8.hpp"
#include "kernel/core/error.hpp"
#include "kernel/effects/effects.hpp"
#include "tests/support/hostile.hpp"
#include "tests/support/mutations.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {

// A plan like those of ensembles and comparisons.
struct FuzzedPart {
  std::string name;
  double value = 0;
};
template <class Members>
void describe(Members& members, FuzzedPart& part) {
  members("name", part.name, input::OneOf{"effect", effects::effects().names()});
  members("value", part.value, input::WithinRange{-1, 1, true});
}
struct FuzzedPlan {
  int runs = 1;
  std::vector<FuzzedPart> parts;
};
template <class Members>
void describe(Members& members, FuzzedPlan& plan) {
  members("runs", plan.runs, input::WithinRange{1, 1000});
  members("parts", plan.parts, input::AsDescribed{});
}

namespace {

namespace fs = std::filesystem;
using testing::Mutations;

constexpr int kInputsOfEach = 1300;

// Tokens of all kinds of files.
std::vector<std::string> tokens() {
  std::vector<std::string> list = {"nan",
                                   "inf",
                                   "-inf",
                                   "1e999",
                                   "-0",
                                   "1e-400",
                                   "\"",
                                   "'''",
                                   "[",
                                   "]",
                                   "{",
                                   "}",
                                   "[[",
                                   "=",
                                   ",",
                                   ";",
                                   "#",
                                   "\n",
                                   "\r\n",
                                   "\\u0000",
                                   "\\",
                                   "a.b.c.d",
                                   "\t",
                                   "null",
                                   "true",
                                   "<",
                                   "/>",
                                   "&",
                                   "9223372036854775808",
                                   "0x7fffffffffffffff",
                                   "1979-05-27",
                                   "sin(",
                                   "))))",
                                   "^",
                                   "?:",
                                   "x=1",
                                   "\xEF\xBB\xBF"};
  for (const std::string& text : testing::hostile_texts())
    if (text.size() < 100) list.push_back(text);
  list.push_back(std::string(2000, '('));
  list.push_back(std::string(2000, '['));
  return list;
}

// How many were read, so that a reader that refuses everything is noticed.
int read_all(const std::vector<std::string>& samples,
             const std::function<void(const std::string&)>& read) {
  for (const std::string& sample : samples) EXPECT_NO_THROW(read(sample)) << sample.substr(0, 200);
  const Mutations mutations(samples, tokens());
  int accepted = 0;
  for (int k = 0; k < kInputsOfEach; ++k) {
    const std::string text = mutations.text(static_cast<std::uint64_t>(k));
    try {
      read(text);
      ++accepted;
    } catch (const InputError& refused) {
      EXPECT_LE(text::in_one_line(refused.what(), 300).size(), 300u);
    } catch (const IoError& refused) {
      EXPECT_LE(text::in_one_line(refused.what(), 300).size(), 300u);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what() << " on " << text::in_one_line(text, 300);
    }
  }
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, kInputsOfEach);
  return accepted;
}

class FuzzTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  fs::path file(const char* name, const std::string& text) const {
    fs::remove(folder.path / name);  // a file that is written over reaches the disk at once
    std::ofstream(folder.path / name, std::ios::binary) << text;
    return folder.path / name;
  }
};

TEST_F(FuzzTest, Configurations) {
  read_all({"case = \"guv-2to1\"\ncells = 32\nepsilon = 0.1\noutput-times = [1, 10, 100]\n"
            "effect = \"exchange:rate=1e-3,target=0.2\"\nfields = false\n",
            config::config_text({{}, {}})},
           [&](const std::string& text) {
             const config::Configuration read({config::read_config_file(file("c.toml", text)), {}});
             (void)config::numerical_identity(read);
             (void)config::flags_text(read);
           });
}

TEST_F(FuzzTest, Tables) {
  read_all({"vesicle,time,perimeter\n1,10,20\n1,20,15.5\n\"3\",1e3,0\n",
            "# a remark\nt,c\r\n1,2\r\n3,4\r\n"},
           [&](const std::string& text) {
             const input::CsvTable table = input::CsvTable::read(file("t.csv", text));
             for (const std::string& column : table.columns()) (void)table.numbers(column);
           });
}

constexpr char kSeries[] =
    "name = \"a\"\nkind = \"measured\"\ntime_zero = \"cooling\"\nlength_unit = \"um\"\n"
    "time_unit = \"s\"\nradius = 5\ncomposition = \"3:1:20\"\ntemperature = 20\n";

TEST_F(FuzzTest, DescriptionsOfSeries) {
  (void)file("measurements.csv", "vesicle,time,perimeter\n1,10,20\n1,20,15\n");
  read_all({kSeries}, [&](const std::string& text) {
    (void)file("dataset.toml", text);
    (void)input::read_dataset(folder.path);
  });
}

TEST_F(FuzzTest, Series) {
  (void)file("dataset.toml", kSeries);
  read_all({"vesicle,time,perimeter,perimeter_sigma,rafts,fraction\n1,10,20,1,3,0.1\n"
            "1,20,15,,2,0.12\n2,10,30,2,,\n",
            "vesicle,time,cap_radius,cap_radius_sigma\n1,10,1.5,0.1\n1,10,0.7,0.1\n1,20,,\n"},
           [&](const std::string& text) {
             (void)file("measurements.csv", text);
             (void)input::read_dataset(folder.path);
           });
}

// Points of a sphere of radius 5 on a spiral.
std::string snapshot() {
  std::string csv = "x,y,z,c,sigma\n";
  for (int k = 0; k < 110; ++k) {
    const double z = (k + 0.5) / 55 - 1, r = std::sqrt(1 - z * z), phi = 2.4 * k;
    csv += format_number(5 * r * std::cos(phi)) + "," + format_number(5 * r * std::sin(phi)) + "," +
           format_number(5 * z) + "," + format_number(z > 0 ? 1 : 0) + ",0.1\n";
  }
  return csv;
}

constexpr char kFields[] =
    "name = \"a\"\nkind = \"synthetic\"\nlength_unit = \"um\"\ntime_unit = \"s\"\nradius = 5\n"
    "blur = 0.2\ntimes = [1, 2]\ntime_zero = \"x\"\norigin = \"y\"\n";

TEST_F(FuzzTest, DescriptionsOfFields) {
  for (const char* name : {"snapshot_001.csv", "snapshot_002.csv"}) (void)file(name, snapshot());
  read_all({kFields}, [&](const std::string& text) {
    (void)file("dataset.toml", text);
    (void)input::read_field_dataset(folder.path);
  });
}

TEST_F(FuzzTest, Fields) {
  (void)file("dataset.toml", kFields);
  (void)file("snapshot_001.csv", snapshot());
  read_all({snapshot()}, [&](const std::string& text) {
    (void)file("snapshot_002.csv", text);
    (void)input::read_field_dataset(folder.path);
  });
}

TEST_F(FuzzTest, Facts) {
  const std::string facts = [] {
    std::ifstream in(std::string(TRACERAFT_ROOT) + "/verification/data/published/guv-3to1.toml");
    return std::string(std::istreambuf_iterator<char>(in), {});
  }();
  ASSERT_FALSE(facts.empty());
  read_all({facts},
           [&](const std::string& text) { (void)input::read_facts(file("f.toml", text)); });
}

TEST_F(FuzzTest, Formulas) {
  read_all({"x^2+y^2+2*z^2-1", "0.5+0.45*sin(8*acos(z/sqrt(x^2+y^2+z^2))+atan2(y,x))",
            "x>0 ? exp(-x) : min(y,z,pi)", "abs(x)*(y<0.5 && z>=0)"},
           [&](const std::string& text) {
             const auto formula = muparser::parse_formula("--initial-formula", text);
             for (const double t : {-1.0, 0.0, 0.3}) (void)formula({t, 1 - t, t * t});
           });
}

TEST_F(FuzzTest, Effects) {
  physics::Units units;
  units.radius_um = 5;
  units.diffusion_cm2_s = 1e-5;
  read_all({"exchange:rate=1e-3,target=0.2", "gravity:strength=0.01;uptake:rate=1e-4",
            "rotation:rate=0.1,x=0,y=0,z=1"},
           [&](const std::string& text) { (void)effects::read_effects(text, units); });
}

TEST_F(FuzzTest, Plans) {
  read_all(
      {"{\"runs\": 10, \"parts\": [{\"name\": \"gravity\", \"value\": 0.5}, {\"name\": "
       "\"uptake\", \"value\": null}]}",
       "{\"runs\": 1, \"parts\": []}"},
      [&](const std::string& text) { (void)input::read_object<FuzzedPlan>(file("p.json", text)); });
}

TEST_F(FuzzTest, Encoders) {
  const Mutations mutations(testing::hostile_texts(), tokens());
  for (std::uint64_t k = 0; k < kInputsOfEach; ++k) {
    const std::string text = mutations.text(k);
    EXPECT_TRUE(text::is_utf8(text::in_terminal(text)));
    EXPECT_TRUE(text::is_utf8(text::in_html(text)));
    EXPECT_EQ(text::in_html(text).find_first_of("<>\"'"), std::string::npos);
    EXPECT_EQ(text::in_gnuplot(text).find_first_of("'\n\r", 1), text::in_gnuplot(text).size() - 1);
    EXPECT_EQ(text::in_markdown(text).find_first_of("<>\n\r"), std::string::npos);
    EXPECT_EQ(text::in_comment(text).find_first_of("\n\r"), std::string::npos);
    EXPECT_LE(text::in_one_line(text, 100).size(), 100u);
  }
}

}  // namespace
}  // namespace traceraft
