#include "kernel/core/named_list.hpp"

#include <gtest/gtest.h>

namespace traceraft {
namespace {

struct Entry {
  std::string name;
};

TEST(NamedList, FindsByNameAndAnswersTheUnknownWithTheNearest) {
  const NamedList<Entry> list("surface", {{"sphere"}, {"torus"}});
  EXPECT_EQ(list.find("torus").name, "torus");
  try {
    list.find("spere");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "unknown surface 'spere'; did you mean 'sphere'? Valid: sphere, torus");
  }
}

TEST(NamedList, KeepsAMessageToOneReadableLine) {
  const std::string message = unknown_name_message("key", std::string(5000, 'x') + "\n\t", {"a"});
  EXPECT_LT(message.size(), 200u);
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(nearest_name("--cels", {"--case", "--cells", "--seed"}), "--cells");
  EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
}  // namespace traceraft
