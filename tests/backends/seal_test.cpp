#include "backends/sodium/seal.hpp"

#include <gtest/gtest.h>

#include <set>

namespace traceraft {
namespace {

// FIPS 180-4, examples of NIST.
TEST(Seal, IsSha256) {
  EXPECT_EQ(sodium::sha256("abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sodium::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Seal, SaltsAndSeedsDiffer) {
  std::set<std::string> salts;
  std::set<std::uint64_t> seeds;
  for (int k = 0; k < 100; ++k) {
    salts.insert(sodium::random_salt());
    seeds.insert(sodium::random_seed());
  }
  EXPECT_EQ(salts.size(), 100u);
  EXPECT_EQ(salts.begin()->size(), 32u);
  EXPECT_EQ(seeds.size(), 100u);
  EXPECT_LT(*seeds.rbegin(), std::uint64_t{1} << 53);
}

}  // namespace
}  // namespace traceraft
