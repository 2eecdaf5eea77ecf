// The quick form of every verification study holds.
#include <gtest/gtest.h>

#include "verification/studies.hpp"

namespace traceraft {
namespace {

class StudyTest : public ::testing::TestWithParam<std::string> {};

TEST_P(StudyTest, Holds) {
  const StudyReport report = studies().find(GetParam()).run({true});
  EXPECT_FALSE(report.claims.empty());
  for (const Claim& claim : report.claims)
    EXPECT_TRUE(claim.holds()) << claim.what << ": " << claim.measured << " is not in ["
                               << claim.low << ", " << claim.high << "]";
}

INSTANTIATE_TEST_SUITE_P(Quick, StudyTest, ::testing::ValuesIn(studies().names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& ch : name)
                             if (ch == '-') ch = '_';
                           return name;
                         });

}  // namespace
}  // namespace traceraft
