#include "drivers/run/run_numbers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "backends/posix/durable_file.hpp"
#include "drivers/input/csv_table.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::TemporaryFolder;

TEST(RunNumbers, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const auto& column : run::run_columns()) EXPECT_TRUE(names.insert(column.name).second);
  for (const auto& total : run::run_totals()) EXPECT_TRUE(names.insert(total.name).second);
}

TEST(RunNumbers, AreReadBackWhateverUnitsTheirHeadingsName) {
  const TemporaryFolder folder;
  const auto file = folder.path / "table.csv";
  for (const bool scaled : {false, true}) {
    const std::string heading = run::csv_heading(run::run_columns(), scaled);
    const auto count = std::count(heading.begin(), heading.end(), ',');
    std::string row = "1";
    for (int k = 0; k < count; ++k) row += "," + std::to_string(k + 2);
    posix::write_durably(file, heading + row + "\n");
    const input::CsvTable table = input::CsvTable::read(file);
    double expected = 0;
    for (const auto& column : run::run_columns())
      EXPECT_EQ(table.number(0, column.name), ++expected);
  }
  EXPECT_EQ(run::csv_heading(run::run_columns(), false)
                .rfind("steps,t (s),dt (s),mass (um^2),energy (um^2),", 0),
            0u);
  EXPECT_EQ(
      run::csv_heading(run::run_columns(), true).rfind("steps,t (R^2/D),dt (R^2/D),mass (R^2),", 0),
      0u);
}

TEST(RunNumbers, AUnitThatIsNotTheProgramsIsPartOfAName) {
  const TemporaryFolder folder;
  const auto file = folder.path / "table.csv";
  posix::write_durably(file, "t (min),perimeter (um)\n1,2\n");
  const input::CsvTable table = input::CsvTable::read(file);
  EXPECT_FALSE(table.has("t"));
  EXPECT_TRUE(table.has("perimeter"));
}

// The text between a mark of this name and the end of it.
std::string marked(const std::string& text, const std::string& name) {
  const std::string begin = "<!-- " + name + " -->\n";
  const std::size_t at = text.find(begin);
  if (at == std::string::npos) return "";
  const std::size_t from = at + begin.size();
  return text.substr(from, text.find("<!-- end -->", from) - from);
}

TEST(RunNumbers, AreInTheDocsAsTheyAreDeclared) {
  const std::string docs = posix::read_file(TRACERAFT_ROOT "/docs/formats.md", 1 << 20);
  EXPECT_EQ(marked(docs, "columns"), output::markdown_table(run::rows_of(run::run_columns())));
  EXPECT_EQ(marked(docs, "totals"), output::markdown_table(run::rows_of(run::run_totals())));
  EXPECT_EQ(marked(docs, "rafts"), output::markdown_table(run::rows_of(run::raft_columns())));
}

}  // namespace
}  // namespace traceraft
