// No two headers define a type of the same name: where both are linked into one program, what
// templates make of the one is taken for the other, and memory is damaged without a warning.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

namespace traceraft {
namespace {

namespace fs = std::filesystem;

TEST(OneDefinition, TypesOfHeadersHaveNamesOfTheirOwn) {
  const fs::path root = TRACERAFT_ROOT;
  const std::regex definition(
      R"(^(?:struct|class|enum class) (\w+)(?: final)?(?: : [^{;]*)? \{.*)");
  std::map<std::string, std::string> defined;  // names and their headers
  for (const char* folder : {"kernel", "backends", "verification", "drivers"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".hpp") continue;
      const std::string header = fs::relative(entry.path(), root).string();
      std::ifstream file(entry.path());
      std::smatch name;
      for (std::string line; std::getline(file, line);)
        if (std::regex_match(line, name, definition)) {
          const auto [before, is_new] = defined.emplace(name[1], header);
          EXPECT_TRUE(is_new) << name[1] << " is defined in " << before->second << " and "
                              << header;
        }
    }
  EXPECT_GT(defined.size(), 200u);
}

}  // namespace
}  // namespace traceraft
