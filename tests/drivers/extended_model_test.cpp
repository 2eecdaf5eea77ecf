// The user's model file with what was found in it.
#include "drivers/explain/extended_model.hpp"

#include <gtest/gtest.h>

#include "backends/posix/durable_file.hpp"
#include "drivers/config/config_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

class ExtendedModelTest : public ::testing::Test {
 protected:
  // The file that is written for the original, with D and gravity found.
  std::string extended(const std::string& original) {
    config::GivenValues wanted;
    if (!original.empty()) {
      posix::write_durably(original_, original);
      wanted = config::read_config_file(original_);
    }
    wanted["radius"] = {"5", "dataset.toml: radius"};
    wanted["epsilon"] = {"0.6", "--epsilon"};
    wanted["diffusion"] = {"2.6e-05", ""};
    wanted["effect"] = {"gravity:strength=0.01", ""};
    explain::write_extended_model(file_, original.empty() ? "" : original_, wanted, "found");
    EXPECT_EQ(config::config_text({config::read_config_file(file_), {}}),
              config::config_text({wanted, {}}));
    return posix::read_file(file_, 1 << 20);
  }

  testing::TemporaryFolder folder;
  const std::filesystem::path original_ = folder.path / "mine.toml",
                              file_ = folder.path / "model.toml";
};

// All of it is the user's, but for one block.
TEST_F(ExtendedModelTest, ChangesOneBlock) {
  const std::string before = "# my vesicle\nepsilon = 0.6  # a guess\n",
                    after = "\nraft-fraction = 0.5\n";
  const std::string text = extended(before + "diffusion=2.5e-5\n" + after);
  EXPECT_EQ(text.find(before + "# found\ndiffusion = 2.6e-05  #"), 0u) << text;
  EXPECT_EQ(text.substr(text.size() - after.size()), after);
  EXPECT_EQ(text.find("2.5e-5"), std::string::npos);
  EXPECT_NE(text.find("\neffect = \"gravity:strength=0.01\"  #"), std::string::npos);
  EXPECT_EQ(text.find("radius"), std::string::npos);  // that of the original
}

TEST_F(ExtendedModelTest, AppendsWhatTheOriginalDoesNotHave) {
  const std::string original = "cells = 24";  // the last line has no end
  const std::string text = extended(original);
  EXPECT_EQ(text.find(original + "\n# found\n"), 0u);
  EXPECT_NE(text.find("\nepsilon = 0.6  #"), std::string::npos);  // a flag
}

TEST_F(ExtendedModelTest, NeedsNoOriginal) {
  EXPECT_EQ(extended("").find("# found\n"), 0u);
}

// TOML has other ways to write a key: then the whole model is written.
TEST_F(ExtendedModelTest, IsTheModelHoweverItWasWritten) {
  const std::string text = extended("\"diffusion\" = 2.5e-5\n");
  EXPECT_EQ(text.find("# found"), std::string::npos);
}

}  // namespace
}  // namespace traceraft
