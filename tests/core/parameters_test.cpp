#include "kernel/core/parameters.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"

namespace traceraft {
namespace {

const std::vector<ParameterSpec> kSpecs = {{"major", "R", 1.0, 0.2, 1.5, ""},
                                           {"minor", "R", 0.4, 0.05, 0.8, ""},
                                           {"seed", "", 1, 0, 9, "", ParameterKind::integer}};

std::string complaint(const std::string& arguments) {
  try {
    parse_parameters("torus", arguments, kSpecs);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Parameters, TakesDefaultsAndValues) {
  const Parameters p = parse_parameters("torus", "minor=0.25", kSpecs);
  EXPECT_EQ(p["major"], 1.0);
  EXPECT_EQ(p["minor"], 0.25);
  EXPECT_THROW(p["radius"], std::logic_error);
}

TEST(Parameters, SaysWhatIsWrongAndWhatIsAllowed) {
  EXPECT_EQ(complaint("miner=1"),
            "torus: unknown parameter 'miner'; did you mean 'minor'? Valid: major, minor, seed");
  EXPECT_EQ(complaint("minor=2"), "torus: minor=2 is out of range (allowed: 0.05 to 0.8)");
  EXPECT_EQ(complaint("minor=0.2,minor=0.3"), "torus: parameter 'minor' is given twice");
  EXPECT_EQ(complaint("seed=1.7"), "torus: seed=1.7 is not a whole number");
  EXPECT_EQ(complaint("minor"), "torus: parameter 'minor' needs a value, as in minor=0.4");
  for (const char* bad :
       {"minor=", "minor=abc", "minor=nan", "minor=inf", "minor=0.2x", "minor=+-0.2", "=1", ","})
    EXPECT_NE(complaint(bad), "") << bad;
}

TEST(Numbers, RoundTripExactly) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 25000.0, -2.5e17})
    EXPECT_EQ(parse_number("x", format_number(value)), value);
  EXPECT_EQ(parse_number("x", "+5"), 5.0);
}

}  // namespace
}  // namespace traceraft
