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
  TableExtent first, all;
  {
    TableFile table(folder.path / "t.csv", {});
    table.append("t,c\n");
    first = table.extent();
    table.append("1,2\n");
    all = table.extent();
  }
  TableFile again(folder.path / "t.csv", first);
  again.append("1,2\n");
  EXPECT_TRUE(again.extent() == all);
  EXPECT_NO_THROW(require_extent(folder.path / "t.csv", all));
}

// Every bit counts, and a damaged file is left as it is.
TEST(TableFile, NoticesDamage) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path / "t.csv";
  TableExtent extent;
  {
    TableFile table(path, {});
    table.append("t,c\n1,2\n");
    extent = table.extent();
    table.append("2,3\n");
  }
  const std::string whole = read_file(path, 100);
  for (std::size_t bit = 0; bit < 8 * extent.bytes; ++bit) {
    write_durably(path, with_a_bit_flipped(whole, bit));
    EXPECT_THROW(TableFile(path, extent), DamagedFile) << bit;
    EXPECT_EQ(read_file(path, 100).size(), whole.size()) << "rows were cut off";
  }
  write_durably(path, whole.substr(0, extent.bytes - 1));
  EXPECT_THROW(TableFile(path, extent), DamagedFile);
  write_durably(path, whole);
  EXPECT_NO_THROW(TableFile(path, extent));
  EXPECT_EQ(read_file(path, 100), whole.substr(0, extent.bytes));
}

TEST(CheckedCsv, NoticesDamage) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path / "t.csv";
  const Table table{"t", {"seed", "value"}, {{"1", 0.5}, {"2", 1.25}}};
  const std::string whole = checked_csv_text(table), rows = csv_text(table);
  write_durably(path, whole);
  EXPECT_EQ(CsvTable::read(path).numbers("value"), (std::vector<double>{0.5, 1.25}));
  for (std::size_t bit = 0; bit < 8 * rows.size(); ++bit) {
    write_durably(path, with_a_bit_flipped(whole, bit));
    EXPECT_THROW(CsvTable::read(path), IoError) << bit;
  }
  write_durably(path, rows);
  EXPECT_NO_THROW(CsvTable::read(path)) << "a table of somebody else has no checksum";
}

}  // namespace
}  // namespace traceraft
