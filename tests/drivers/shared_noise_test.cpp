// Noise that neighbours share, as options and as a campaign keeps it.
#include "drivers/campaign/shared_noise.hpp"

#include <gtest/gtest.h>

#include "drivers/campaign/campaign_folder.hpp"
#include "kernel/core/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

TEST(SharedNoise, IsSetAsAWhole) {
  selection::BlindRequest request;
  campaign::set_shared_noise({}, request);
  EXPECT_EQ(request.noise_share, 0);
  campaign::set_shared_noise({0.05, 0.2, "exponential"}, request);
  EXPECT_EQ(request.noise_share, 0.2);
  EXPECT_EQ(request.noise_correlation, 0.05);
  EXPECT_EQ(request.noise_shape, selection::NoiseShape::exponential);
}

TEST(SharedNoise, RefusesHalfOfIt) {
  EXPECT_THROW(campaign::check_shared_noise({0, 0.2, "gaussian"}), InputError);
  EXPECT_THROW(campaign::check_shared_noise({0.05, 0, "gaussian"}), InputError);
  EXPECT_THROW(campaign::check_shared_noise({0.05, 0.2, "round"}), InputError);
}

TEST(SharedNoise, IsPartOfAPlan) {
  const testing::TemporaryFolder folder;
  const campaign::CampaignFolder campaign(folder.path);
  campaign::CampaignPlan plan;
  plan.groups = {"null"};
  campaign.save(plan);
  const campaign::CampaignPlan white = campaign.load();
  EXPECT_EQ(white.noise.share, 0);
  plan.noise = {0.05, 0.2, "exponential"};
  campaign.save(plan);
  const campaign::CampaignPlan shared = campaign.load();
  EXPECT_EQ(shared.noise.share, 0.2);
  EXPECT_EQ(shared.noise.length, 0.05);
  EXPECT_EQ(shared.noise.shape, "exponential");
  EXPECT_FALSE(campaign::same_but_for_cases(white, shared));
}

}  // namespace
}  // namespace traceraft
