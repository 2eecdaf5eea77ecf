#include "verification/selection/blind/blind_case.hpp"

#include <gtest/gtest.h>

#include "kernel/core/error.hpp"
#include "tests/support/small_vesicle.hpp"
#include "verification/selection/blind/effect_size.hpp"

namespace traceraft::selection {
namespace {

// A hidden effect has to be one that a model may have.
TEST(BlindCase, HidesNoMoreThanTheRangeOfAnEffect) {
  BlindRequest asked = testing::small_vesicle(3);
  asked.effects = {"asymmetry"};
  asked.gap = 2;
  const effects::EffectTerm term = size_effects(asked).front();
  EXPECT_EQ(std::fabs(term.values.front()),
            effects::effects().find("asymmetry").parameters.front().max);
  asked.gap = 0.02;
  EXPECT_LT(std::fabs(size_effects(asked).front().values.front()), 0.2);
}

// Between three looks within the same time there is more time for an effect of the same gap.
TEST(BlindCase, MayBeAsStrongAsBetweenMoreLooks) {
  BlindRequest asked = testing::small_vesicle(3);
  asked.effects = {"allen-cahn"};
  asked.snapshots = 6;
  const auto strength = [&] { return size_effects(asked).front().values.front(); };
  const double between_six = strength();
  asked.snapshots = 3;
  EXPECT_LT(strength(), 0.7 * between_six);
  asked.sizing_snapshots = 6;
  EXPECT_EQ(strength(), between_six);
}

// Smooth noise dissolves where the mixture is stable, as vesicles of few rafts are.
TEST(BlindCase, StartsFromWhatTheModelDoes) {
  BlindRequest asked = testing::small_vesicle(3);
  asked.raft_fraction = 0.16;
  EXPECT_THROW((void)size_effects(asked), InputError);
  asked.initial = "noise";
  EXPECT_GT(std::fabs(size_effects(asked).front().values.front()), 0);
}

}  // namespace
}  // namespace traceraft::selection
