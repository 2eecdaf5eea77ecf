#include "drivers/input/csv_table.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft::input {
namespace {

class CsvTableTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  CsvTable read(const std::string& text) const {
    std::ofstream(folder.path / "data.csv", std::ios::binary) << text;
    return CsvTable::read(folder.path / "data.csv");
  }
  std::string complaint(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(CsvTableTest, SaysThatItReadsNoUtf16) {
  using namespace std::string_literals;
  EXPECT_NE(complaint("\xFF\xFEt\0,\0c\0\n\0"s).find("UTF-16"), std::string::npos);
}

TEST_F(CsvTableTest, ReadsWhatSpreadsheetsWrite) {
  const CsvTable table =
      read("\xEF\xBB\xBFtime, name\r\n1.5,\"a, \"\"b\"\"\"\r\n\r\n# a remark\r\n-2e3,\r\n");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"time", "name"}));
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.numbers("time"), (std::vector<double>{1.5, -2000}));
  EXPECT_EQ(table.text(0, "name"), "a, \"b\"");
  EXPECT_TRUE(table.empty(1, "name"));
  EXPECT_FALSE(table.has("radius"));
  EXPECT_NE(table.where(1, "time").find("data.csv:5: column 'time'"), std::string::npos);
}

TEST_F(CsvTableTest, CountsLinesThatEndAsOnOldMacintoshes) {
  const CsvTable table = read("time,name\r1,a\r2,b\r");
  EXPECT_EQ(table.numbers("time"), (std::vector<double>{1, 2}));
  EXPECT_NE(table.where(1, "time").find("data.csv:3"), std::string::npos);
}

TEST_F(CsvTableTest, SaysWhereItIsNotUtf8) {
  EXPECT_NE(complaint("t,a\n1,x\n2,caf\xE9\n").find("data.csv:3: this is not UTF-8"),
            std::string::npos);
}

TEST_F(CsvTableTest, LeavesRowsWithoutAValueOut) {
  const CsvTable table = read("t,a\n1,x\n,\n2,\n,\n");
  EXPECT_EQ(table.numbers("t"), (std::vector<double>{1, 2}));
  EXPECT_NE(table.where(1, "t").find("data.csv:4"), std::string::npos);
}

TEST_F(CsvTableTest, SaysWhatNumbersWithCommasLookLike) {
  EXPECT_NE(complaint("t,a\n1,5,2,5\n").find("have commas instead"), std::string::npos);
}

TEST_F(CsvTableTest, EndsWithoutANewline) {
  EXPECT_EQ(read("t\n1\n2").numbers("t"), (std::vector<double>{1, 2}));
}

TEST_F(CsvTableTest, RefusesOtherSeparators) {
  EXPECT_NE(complaint("a;b\n1,5;2\n").find("data.csv:1: columns are separated by semicolons"),
            std::string::npos);
  EXPECT_NE(complaint("a\tb\n1\t2\n").find("separated by tabs"), std::string::npos);
  EXPECT_EQ(complaint("a,b;c\n1,2\n"), "");  // a name may hold one
}

TEST_F(CsvTableTest, SaysWhereItIsNoTable) {
  EXPECT_NE(complaint("").find("empty"), std::string::npos);
  EXPECT_NE(complaint("a,b\n1,2\n3\n").find("data.csv:3: 1 cells, but there are 2"),
            std::string::npos);
  EXPECT_NE(complaint("a,a\n").find("two columns are called 'a'"), std::string::npos);
  EXPECT_NE(complaint("a,b\n1,\"2\n").find("data.csv:2"), std::string::npos);
  const CsvTable table = read("a\none\n");
  try {
    (void)table.number(0, "a");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("data.csv:2: column 'a': 'one' is not a"),
              std::string::npos);
  }
  try {
    table.require("time");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no column 'time' (there are: a)"), std::string::npos);
  }
}

}  // namespace
}  // namespace traceraft::input
