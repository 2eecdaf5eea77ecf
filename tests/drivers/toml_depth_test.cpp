#include "drivers/config/toml_depth.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/config/toml_table.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

std::string dotted(int parts, const std::string& part = "a") {
  std::string key = part;
  for (int k = 1; k < parts; ++k) key += "." + part;
  return key;
}

TEST(TomlDepth, CountsThePartsOfKeysAndOfHeadings) {
  EXPECT_EQ(config::line_of_deep_key("cells = 3\n" + dotted(config::kMostKeyParts) + " = 1\n"), 0);
  EXPECT_EQ(config::line_of_deep_key("cells = 3\n" + dotted(config::kMostKeyParts + 1) + " = 1\n"),
            2);
  EXPECT_EQ(config::line_of_deep_key("\n\n[" + dotted(100) + "]\n"), 3);
  EXPECT_EQ(config::line_of_deep_key("x = {" + dotted(100, "\"a b\"") + " = 1}"), 1);
  EXPECT_EQ(config::line_of_deep_key(dotted(100, "'a' ") + " = 1"), 1);
}

TEST(TomlDepth, IsNotThatOfTextsRemarksAndNumbers) {
  const std::string dots(200, '.');
  EXPECT_EQ(config::line_of_deep_key("x = \"" + dots + "\\\"" + dots + "\"\n"), 0);
  EXPECT_EQ(config::line_of_deep_key("x = '" + dots + "'\n# " + dots + "\n"), 0);
  EXPECT_EQ(config::line_of_deep_key("x = \"\"\"\n" + dots + "\n\"\"\"\n"), 0);
  std::string list = "times = [0.5";
  for (int k = 0; k < 500; ++k) list += ", 1.5";
  EXPECT_EQ(config::line_of_deep_key(list + "]\n"), 0);
}

// The parser calls itself for every part: the stack was gone.
TEST(TomlTable, RefusesKeysOfManyPartsInOneLine) {
  const testing::TemporaryFolder folder;
  for (const std::string& text : {dotted(87000) + " = 1\n", "[" + dotted(87000) + "]\n"}) {
    std::ofstream(folder.path / "deep.toml") << text;
    try {
      config::TomlTable::read(folder.path / "deep.toml", {"a"});
      FAIL();
    } catch (const InputError& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find("deep.toml:1: a key of many parts"), std::string::npos) << said;
      EXPECT_EQ(said.find('\n'), std::string::npos);
    }
  }
}

// A debug build of the parser aborts on it by default.
TEST(TomlTable, RefusesHeadingsWithoutAName) {
  const testing::TemporaryFolder folder;
  for (const char* text : {"a = 1\n[= 2\n", "a = 1\n[[ =\n", "a = 1\n[\n"}) {
    std::ofstream(folder.path / "heading.toml") << text;
    try {
      config::TomlTable::read(folder.path / "heading.toml", {"a"});
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find("heading.toml:2: this is no TOML"), std::string::npos) << said;
    }
  }
}

// A double holds no more digits.
TEST(TomlTable, RefusesWholeNumbersWithTooManyDigits) {
  const testing::TemporaryFolder folder;
  const auto table = [&](const std::string& text) {
    std::ofstream(folder.path / "data.toml") << text;
    return config::TomlTable::read(folder.path / "data.toml", {"a"});
  };
  EXPECT_EQ(table("a = 9007199254740992\n").number("a"), 9007199254740992.0);
  EXPECT_THROW(table("a = 9007199254740993\n").number("a"), InputError);
  EXPECT_THROW(table("a = [1, -9007199254740993]\n"), InputError);
  EXPECT_NO_THROW(table("a = [1, 1e300]\n"));
}

}  // namespace
}  // namespace traceraft
