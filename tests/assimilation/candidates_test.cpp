#include "verification/assimilation/forecast/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/spaces.hpp"

namespace traceraft::assimilation {
namespace {

std::set<std::string> names_on(const std::string& surface) {
  std::set<std::string> names;
  for (const Candidate& candidate :
       candidates_for(testing::make_model(), *geometry::make_surface(surface),
                      testing::make_space(24, surface)->surface.position, {"gravity"}))
    names.insert(candidate.name);
  return names;
}

TEST(Candidates, AreThoseThatASurfaceShows) {
  const std::set<std::string> sphere = names_on("sphere"), ellipsoid = names_on("ellipsoid"),
                              torus = names_on("torus:major=1,minor=0.4");
  EXPECT_EQ(sphere.count("curvature"), 0U);
  EXPECT_EQ(ellipsoid.count("curvature"), 1U);
  // Flow needs a surface that rays from its centre meet once.
  for (const std::string flow : {"flow", "brownian-flow"}) {
    EXPECT_EQ(sphere.count(flow), 1U) << flow;
    EXPECT_EQ(ellipsoid.count(flow), 1U) << flow;
    EXPECT_EQ(torus.count(flow), 0U) << flow;
  }
  for (const auto& names : {sphere, ellipsoid, torus}) EXPECT_EQ(names.count("gravity"), 0U);
}

TEST(Candidates, OfAModelAreNamedByTheStrengthThatItHas) {
  const Candidate brownian = find_candidate("brownian-flow").value(),
                  capillary = find_candidate("flow").value();
  EXPECT_EQ(candidate_name(brownian.term({0.1})), "brownian-flow");
  EXPECT_EQ(candidate_name(capillary.term({0.1})), "flow");
  const Hypothesis own = of_model({brownian.term({0.1}), capillary.term({3})});
  EXPECT_EQ(own.parts[0].coefficients, std::vector<double>{0.1});
  EXPECT_EQ(own.parts[1].coefficients, std::vector<double>{3});
  EXPECT_TRUE(own.is_random());
  EXPECT_FALSE(of_model({capillary.term({3})}).is_random());
  // Forecasts are those without the random one.
  const auto model = effects::with_effects(testing::make_model(), own.terms());
  EXPECT_EQ(model.effects.size(), 2U);
  EXPECT_EQ(problem::without_noise(model).effects.size(), 1U);
}

}  // namespace
}  // namespace traceraft::assimilation
