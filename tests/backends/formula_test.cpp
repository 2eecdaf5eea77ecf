#include "backends/muparser/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

TEST(Formula, IsEvaluated) {
  const auto f = muparser::parse_formula("--initial-formula", "0.5 + sin(pi*x)*y - abs(z)^2");
  EXPECT_NEAR(f({0.5, 2, -3}), 0.5 + 2 - 9, 1e-14);
  EXPECT_NEAR(f({0, 2, 0}), 0.5, 1e-14);
}

TEST(Formula, MayCompareAndNotAssign) {
  EXPECT_EQ(muparser::parse_formula("f", "x>=0.5 ? (y==2) : (z!=1)*(x<=0)")({0.5, 2, 0}), 1);
  for (const char* bad : {"x=1", "x = 1", "(y=2)+x", "z^2=1", "x===1", "x+(e=3)", "x<==1"}) {
    try {
      muparser::parse_formula("--initial-formula", bad);
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("'=' assigns; write =="), std::string::npos)
          << error.what();
    }
  }
}

TEST(Formula, SaysWhatItCannotRead) {
  for (const char* bad : {"", "x+", "q*2", "sin(", "x y", "1,,2", "0,5+x", "\xff"}) {
    try {
      muparser::parse_formula("--initial-formula", bad);
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("--initial-formula: "), 0u);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace traceraft
