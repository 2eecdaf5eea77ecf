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

TEST(NamedList, ProposesWhatIsNear) {
  const auto proposes = [](const char* name, const char* valid) {
    return unknown_name_message("unit", name, {valid}).find("did you mean") != std::string::npos;
  };
  EXPECT_FALSE(proposes("micron", "mm"));
  EXPECT_FALSE(proposes("operator", "temperature"));
  EXPECT_FALSE(proposes("D", "epsilon"));
  EXPECT_FALSE(proposes("--effect", "--quiet"));
  EXPECT_FALSE(proposes("--cells", "--help"));
  EXPECT_FALSE(proposes("--seed", "--keep"));
  EXPECT_TRUE(proposes("--cels", "--cells"));
  EXPECT_TRUE(proposes("guv", "guv-2to1"));
  EXPECT_TRUE(proposes("lsit", "list"));
  EXPECT_TRUE(proposes("rnu", "run"));
  EXPECT_TRUE(proposes("--sede", "--seed"));
  EXPECT_TRUE(proposes("radius_um", "radius"));
  EXPECT_EQ(unknown_name_message("unit", "micron", {"um", "nm"}),
            "unknown unit 'micron'; valid: um, nm");
  // However many there are, where none is near.
  EXPECT_NE(unknown_name_message("key", "operator", std::vector<std::string>(20, "temperature"))
                .find("valid: temperature, temperature"),
            std::string::npos);
}

TEST(NamedList, KeepsAMessageToOneReadableLine) {
  const std::string message = unknown_name_message("key", std::string(5000, 'x') + "\n\t", {"a"});
  EXPECT_LT(message.size(), 200u);
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(NearestName, CountsEdits) {
  EXPECT_EQ(nearest_name("--cels", {"--case", "--cells", "--seed"}), "--cells");
  EXPECT_EQ(nearest_name("x", {}), "");
  // A swap is one edit, wherever it is.
  EXPECT_EQ(nearest_name("abdc", {"abxy", "abcd"}), "abcd");
}

}  // namespace
}  // namespace traceraft
