#include "drivers/input/json_members.hpp"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"

namespace traceraft::input {
namespace {

struct Part {
  double size = 0;
};
template <class Members>
void describe(Members& members, Part& part) {
  members("size", part.size, WithinRange{0, 10, true});
}

struct Whole {
  int runs = 1;
  std::uint64_t seed = 0;
  bool quick = false;
  std::vector<std::string> words;
  std::vector<Part> parts;
  std::map<std::string, std::string> texts;
  double share = 0;
};
template <class Members>
void describe(Members& members, Whole& whole) {
  members("runs", whole.runs, WithinRange{1, 100000});
  members("seed", whole.seed, WithinRange{0, 9007199254740992});
  members("quick", whole.quick, AnyFlag{});
  members("words", whole.words, OneOf{"word", {"alpha", "beta"}});
  members("parts", whole.parts, AsDescribed{});
  members("texts", whole.texts, AnyText{});
  members("share", whole.share, WithinRange{0, 1});
}

class JsonMembersTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "plan.json";
  const Whole whole{3, 9007199254740992, true, {"beta"}, {{0.1}, {NAN}}, {{"a", "b"}}};

  std::string complaint(const char* member, const Json& value) {
    Json json = object_of(whole);
    json[member] = value;
    posix::write_durably(file, json.dump());
    try {
      (void)read_object<Whole>(file);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(JsonMembersTest, ComeBackAsTheyWere) {
  posix::write_durably(file, object_of(whole).dump());
  const Whole read = read_object<Whole>(file);
  EXPECT_EQ(read.runs, 3);
  EXPECT_EQ(read.seed, whole.seed);
  EXPECT_TRUE(read.quick);
  EXPECT_EQ(read.words, whole.words);
  ASSERT_EQ(read.parts.size(), 2u);
  EXPECT_EQ(read.parts[0].size, 0.1);
  EXPECT_TRUE(std::isnan(read.parts[1].size));
  EXPECT_EQ(read.texts, whole.texts);
}

// Out of range and unknown is bad input, what no writer writes is damage.
TEST_F(JsonMembersTest, AreChecked) {
  for (const Json& runs : {Json(-5), Json(2147483647), Json(1e8), Json(0)}) {
    EXPECT_NE(complaint("runs", runs).find("plan.json: runs: "), std::string::npos) << runs;
    EXPECT_THROW((void)read_object<Whole>(file), InputError) << runs;
  }
  EXPECT_NE(complaint("runs", 1e300).find("allowed: 1 to 1e+05"), std::string::npos);
  EXPECT_NE(
      complaint("words", {"alpa"}).find("words[0]: unknown word 'alpa'; did you mean 'alpha'"),
      std::string::npos);
  EXPECT_THROW((void)read_object<Whole>(file), InputError);
  EXPECT_NE(complaint("parts", {{{"size", 11}}}).find("parts[0]: size: 11"), std::string::npos);
  for (const auto& [member, value] :
       std::initializer_list<std::pair<const char*, Json>>{{"runs", "3"},
                                                           {"runs", 1.5},
                                                           {"runs", Json()},
                                                           {"runs", {3}},
                                                           {"share", Json()},
                                                           {"quick", 1},
                                                           {"words", "beta"},
                                                           {"words", {1}},
                                                           {"parts", {1}},
                                                           {"parts", {Json::object()}},
                                                           {"texts", {"a"}}}) {
    EXPECT_NE(complaint(member, value).find("is damaged"), std::string::npos) << member << value;
    EXPECT_THROW((void)read_object<Whole>(file), DamagedFile) << member << value;
  }
}

TEST_F(JsonMembersTest, AreAllNeeded) {
  const Json all = object_of(whole);
  for (const auto& [name, value] : all.items()) {
    Json json = all;
    json.erase(name);
    posix::write_durably(file, json.dump());
    EXPECT_THROW((void)read_object<Whole>(file), DamagedFile) << name;
  }
  for (const char* text : {"[1]", "{", "", "3", "null"}) {
    posix::write_durably(file, text);
    EXPECT_THROW((void)read_object<Whole>(file), DamagedFile) << text;
  }
}

// Deep lists are refused before anything goes down into them.
TEST_F(JsonMembersTest, MayNotBeDeep) {
  constexpr int kDepth = 200000;
  const std::string deep = std::string(kDepth, '[') + std::string(kDepth, ']');
  for (const std::string& text :
       {"{\"checksum\":\"00000000\",\"x\":" + deep + "}", "{\"checksum\":" + deep + "}", deep}) {
    posix::write_durably(file, text);
    EXPECT_THROW((void)read_object<Whole>(file), DamagedFile);
  }
}

// One changed byte at any place, in names and values alike.
TEST_F(JsonMembersTest, AreSealedByAChecksum) {
  const std::string text = checked_text(object_of(whole));
  posix::write_durably(file, text);
  EXPECT_EQ(read_object<Whole>(file).words, whole.words);
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == ' ' || text[at] == '\n') continue;  // between members
    std::string changed = text;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    posix::write_durably(file, changed);
    EXPECT_THROW((void)read_object<Whole>(file), DamagedFile) << changed;
  }
  Json by_hand = Json::parse(text);
  by_hand.erase("checksum");
  by_hand["runs"] = 4;
  posix::write_durably(file, by_hand.dump());
  EXPECT_EQ(read_object<Whole>(file).runs, 4);
}

TEST_F(JsonMembersTest, StandThereOnce) {
  posix::write_durably(file, R"({"runs": 3, "runs": 4})");
  try {
    (void)read_object<Whole>(file);
    FAIL();
  } catch (const DamagedFile& error) {
    EXPECT_NE(std::string(error.what()).find("'runs' stands there twice"), std::string::npos);
  }
}

}  // namespace
}  // namespace traceraft::input
