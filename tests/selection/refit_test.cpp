#include "verification/selection/fit/refit.hpp"

#include <gtest/gtest.h>

#include "tests/support/small_vesicle.hpp"
#include "verification/assimilation/forecast/candidates.hpp"
#include "verification/selection/fit/refit_unknowns.hpp"

namespace traceraft::selection {
namespace {

TEST(RefitUnknowns, RatesAreTheSameAtAnotherDiffusionRatio) {
  assimilation::FilterModel model{testing::small_vesicle(3).base, 2, {}, {}};
  model.hypothesis.parts = {{assimilation::find_candidate("uptake").value(), {0.3}},
                            {assimilation::find_candidate("gravity").value(), {0.3}}};
  const assimilation::FilterModel faster = at_diffusion_ratio(model, 6);
  EXPECT_EQ(faster.diffusion_ratio, 6);
  EXPECT_NEAR(faster.hypothesis.parts[0].coefficients[0], 0.1, 1e-15);
  EXPECT_EQ(faster.hypothesis.parts[1].coefficients[0], 0.3);
  EXPECT_LT((unknowns(faster) - unknowns(model)).tail(2).norm(), 1e-15);
}

TEST(ShareClosed, IsOfMeanSquares) {
  EXPECT_NEAR(assimilation::share_closed(5, 4, 3).value(), 9.0 / 16, 1e-14);
  EXPECT_NEAR(assimilation::share_closed(2, 1, 1).value(), 1, 1e-14);
  EXPECT_LT(assimilation::share_closed(2, 2.1, 1).value(), 0);
  EXPECT_EQ(assimilation::share_closed(2, 0.9, 1).value(), 1) << "more than all is noise";
  EXPECT_FALSE(assimilation::share_closed(1.01, 1, 1));
  EXPECT_FALSE(assimilation::share_closed(0, 0, 0));  // nothing is held out
}

}  // namespace
}  // namespace traceraft::selection
