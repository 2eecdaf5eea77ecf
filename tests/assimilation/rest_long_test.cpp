// Rafts at rest say nothing of kinetics, and rafts that move do, however little.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/support/small_vesicle.hpp"
#include "verification/assimilation/filter/rest.hpp"
#include "verification/selection/search/steps.hpp"

namespace traceraft::assimilation {
namespace {

constexpr int kRestCells = 20;

// Three snapshots of rafts with nothing hidden, 5 % noise.
selection::BlindRequest rafts_between(double first, double last) {
  selection::BlindRequest asked = testing::small_vesicle(3);
  asked.effects.clear();
  asked.first = first;
  asked.last = last;
  return asked;
}

bool rest(const std::vector<FieldSeries>& vesicles, const problem::CahnHilliardModel& base,
          const FilterSettings& settings = {}) {
  return are_at_rest(make_filter_problems(vesicles, geometry::make_surface("sphere"), base,
                                          kRestCells, 2, false, settings),
                     base);
}

const selection::BlindCase& late() {
  static const selection::BlindCase drawn = selection::draw_blind_case(rafts_between(4000, 9000));
  return drawn;
}
const std::vector<FieldSeries>& late_vesicle() {
  return late().vesicles;
}

TEST(Rest, IsSeenAlsoOfAVesicleThatTurns) {
  const problem::CahnHilliardModel base = testing::small_vesicle(3).base;
  EXPECT_TRUE(rest(late_vesicle(), base));
  std::vector<FieldSeries> turned = late_vesicle();
  double angle = 0;
  for (FieldSnapshot& snapshot : turned.front().snapshots) {
    const Eigen::Matrix3d Q =
        Eigen::AngleAxisd(angle, Point(1, -2, 0.5).normalized()).toRotationMatrix();
    for (Point& x : snapshot.points) x = Q * x;
    angle += 0.7;
  }
  EXPECT_TRUE(rest(turned, base));
}

TEST(Rest, IsSeenThroughAMicroscope) {
  selection::BlindRequest asked = rafts_between(4000, 9000);
  asked.blur = 0.3;
  const std::vector<FieldSeries> blurred = selection::draw_blind_case(asked).vesicles;
  FilterSettings microscope;
  microscope.blur = asked.blur;
  EXPECT_TRUE(rest(blurred, asked.base, microscope));
  EXPECT_FALSE(rest(blurred, asked.base)) << "boundaries of another width than the model's";
}

// One vesicle that changes is enough.
TEST(Rest, IsNotWhereRaftsChange) {
  selection::BlindRequest asked = rafts_between(20, 60);
  const std::vector<FieldSeries> moving = selection::draw_blind_case(asked).vesicles;
  EXPECT_FALSE(rest(moving, asked.base));
  std::vector<FieldSeries> both = late_vesicle();
  both.push_back(moving.front());
  EXPECT_FALSE(rest(both, asked.base));
}

// Rafts that the model would coarsen, but stay; and boundaries of another width than its.
TEST(Rest, IsNotWhereTheModelDoesNotRest) {
  selection::BlindRequest asked = rafts_between(20, 20.002);
  std::vector<FieldSeries> arrested = selection::draw_blind_case(asked).vesicles;
  for (std::size_t k = 0; k < 3; ++k)
    arrested.front().snapshots[k].time = 20 + 1000 * static_cast<double>(k);
  EXPECT_FALSE(rest(arrested, asked.base));

  problem::CahnHilliardModel wider = asked.base;
  wider.epsilon *= 1.4;
  EXPECT_FALSE(rest(late_vesicle(), wider));
}

selection::ExplainRequest request_for_rest() {
  selection::ExplainRequest request;
  request.base = testing::small_vesicle(3).base;
  request.surface = geometry::make_surface("sphere");
  request.cells = kRestCells;
  return request;
}

// Rafts that the model with its own effects would not leave as they are.
TEST(Rest, IsHeldAgainstTheWholeModel) {
  selection::ExplainRequest request = request_for_rest();
  request.own = of_model({{"uptake", {1e-4}}});
  // The search begins by a fit of D; more of it is not needed.
  struct Begun {};
  request.progress = [](const std::string& news) {
    if (news.rfind("fit D", 0) == 0) throw Begun();
  };
  selection::Search search(late_vesicle(), request);
  EXPECT_THROW(selection::next_state(search, {}), Begun);
  request.own = {};
  request.progress = nullptr;
  selection::Search without(late_vesicle(), request);
  EXPECT_TRUE(selection::next_state(without, {}).so_far.at_rest);
}

// Nothing is fitted then, and the search ends at once.
TEST(Rest, EndsTheSearch) {
  selection::ExplainRequest request = request_for_rest();
  int states = 0;
  request.save = [&](const selection::SearchState&) { ++states; };
  const selection::Explanation found = selection::explain_fields(late_vesicle(), request);
  EXPECT_TRUE(found.at_rest);
  EXPECT_EQ(found.finding, selection::Finding::not_identifiable);
  EXPECT_EQ(states, 1);
  EXPECT_TRUE(selection::bounds_of(found).empty());
  EXPECT_NEAR(found.noise, late().noise, 0.05 * late().noise);
}

}  // namespace
}  // namespace traceraft::assimilation
