#include "drivers/run/table_file.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/input/csv_table.hpp"
#include "drivers/output/text_table.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::TemporaryFolder;

std::string with_a_bit_flipped(std::string text, std::size_t bit) {
  text[bit / 8] = static_cast<char>(text[bit / 8] ^ (1 << (bit % 8)));
  return text;
}

TEST(TableFile, GrowsFromWhereItWas) {
  const TemporaryFolder folder;
  run::TableExtent first, all;
  {
    run::TableFile table(folder.path / "t.csv", {});
    table.append("t,c\n");
    first = table.extent();
    table.append("1,2\n");
    all = table.extent();
  }
  run::TableFile again(folder.path / "t.csv", first);
  again.append("1,2\n");
  EXPECT_TRUE(again.extent() == all);
  EXPECT_NO_THROW(run::require_extent(folder.path / "t.csv", all));
}

// Every bit counts, and a damaged file is left as it is.
TEST(TableFile, NoticesDamage) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path / "t.csv";
  run::TableExtent extent;
  {
    run::TableFile table(path, {});
    table.append("t,c\n1,2\n");
    extent = table.extent();
    table.append("2,3\n");
  }
  const std::string whole = posix::read_file(path, 100);
  for (std::size_t bit = 0; bit < 8 * extent.bytes; ++bit) {
    posix::write_durably(path, with_a_bit_flipped(whole, bit));
    EXPECT_THROW(run::TableFile(path, extent), DamagedFile) << bit;
    EXPECT_EQ(posix::read_file(path, 100).size(), whole.size()) << "rows were cut off";
  }
  posix::write_durably(path, whole.substr(0, extent.bytes - 1));
  EXPECT_THROW(run::TableFile(path, extent), DamagedFile);
  posix::write_durably(path, whole);
  EXPECT_NO_THROW(run::TableFile(path, extent));
  EXPECT_EQ(posix::read_file(path, 100), whole.substr(0, extent.bytes));
}

TEST(CheckedCsv, NoticesDamage) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path / "t.csv";
  const bench::Table table{"t", {"seed", "value"}, {{"1", 0.5}, {"2", 1.25}}};
  const std::string whole = output::checked_csv_text(table), rows = output::csv_text(table);
  posix::write_durably(path, whole);
  EXPECT_EQ(input::CsvTable::read(path).numbers("value"), (std::vector<double>{0.5, 1.25}));
  for (std::size_t bit = 0; bit < 8 * rows.size(); ++bit) {
    posix::write_durably(path, with_a_bit_flipped(whole, bit));
    EXPECT_THROW(input::CsvTable::read(path), IoError) << bit;
  }
  posix::write_durably(path, rows);
  EXPECT_NO_THROW(input::CsvTable::read(path)) << "a table of somebody else has no checksum";
}

}  // namespace
}  // namespace traceraft
