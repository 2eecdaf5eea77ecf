// Results that must not depend on the number of ranks, and those that may only to roundoff.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "kernel/core/checkpoint_stream.hpp"
#include "kernel/effects/effects.hpp"
#include "kernel/fem/trace.hpp"
#include "kernel/linear/linear_solver.hpp"
#include "kernel/observables/observables.hpp"
#include "kernel/observables/surface_view.hpp"
#include "kernel/problem/prescribed_density.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/strong_effects.hpp"
#include "tests/support/thread_ranks.hpp"

namespace traceraft::problem {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;
using testing::run_on_ranks;

constexpr int kCells = 24;

std::shared_ptr<const fem::SurfaceSpace> part_of(std::shared_ptr<const Communicator> ranks,
                                                 const std::string& surface = "sphere") {
  return std::make_shared<fem::SurfaceSpace>(geometry::make_surface(surface), kCells,
                                             std::make_shared<ThreadTeam>(1), std::move(ranks));
}

// A state that is a function of the nodes' ids.
Vec state_on(const fem::SurfaceSpace& space, std::uint64_t seed) {
  const int n = space.nodes();
  Vec y(2 * n);
  for (int i = 0; i < n; ++i) {
    const auto id = static_cast<std::uint64_t>(space.mesh.node_id[i]);
    y[i] = -0.2 + 1.4 * uniform_random(seed, 1, id);
    y[n + i] = -1 + 2 * uniform_random(seed, 2, id);
  }
  return y;
}

// Row by row and column by column in terms of ids, which is what all distributions share.
using Row = std::map<std::int64_t, double>;
std::map<std::int64_t, Row> rows_of(const fem::SurfaceSpace& space, const fem::CsrMatrix& A) {
  std::map<std::int64_t, Row> rows;
  for (int i = 0; i < space.nodes(); ++i)
    for (int k = A.pattern->row_begin[i]; k < A.pattern->row_begin[i + 1]; ++k)
      rows[space.mesh.node_id[i]][space.mesh.node_id[A.pattern->column[k]]] = A.values[k];
  return rows;
}
void expect_rows_within(const std::map<std::int64_t, Row>& part,
                        const std::map<std::int64_t, Row>& whole, const char* what) {
  for (const auto& [id, row] : part) EXPECT_EQ(row, whole.at(id)) << what << ", row " << id;
}

std::map<std::int64_t, double> entries_of(const fem::SurfaceSpace& space, VecView field) {
  std::map<std::int64_t, double> entries;
  for (int i = 0; i < space.nodes(); ++i) entries[space.mesh.node_id[i]] = field[i];
  return entries;
}
void expect_entries_within(const std::map<std::int64_t, double>& part,
                           const std::map<std::int64_t, double>& whole, const char* what) {
  for (const auto& [id, value] : part) EXPECT_EQ(value, whole.at(id)) << what << ", node " << id;
}

class Distribution : public ::testing::TestWithParam<int> {};

TEST_P(Distribution, MatricesAreBitwiseThoseOfOneRank) {
  const auto whole = make_space(kCells);
  const auto expected_mass = rows_of(*whole, whole->mass);
  const auto expected_stiffness = rows_of(*whole, whole->stiffness);
  const auto expected_normal = rows_of(*whole, whole->normal_stiffness);
  run_on_ranks(GetParam(), [&](const auto& ranks) {
    const auto part = part_of(ranks);
    expect_rows_within(rows_of(*part, part->mass), expected_mass, "M");
    expect_rows_within(rows_of(*part, part->stiffness), expected_stiffness, "K");
    expect_rows_within(rows_of(*part, part->normal_stiffness), expected_normal, "S");
    EXPECT_EQ(part->totals.nodes, whole->totals.nodes);
    EXPECT_EQ(part->totals.elements, whole->totals.elements);
    EXPECT_EQ(part->totals.euler_characteristic, 2);
    EXPECT_NEAR(part->area, whole->area, 1e-13);
  });
}

TEST_P(Distribution, ResidualAndJacobianAreBitwiseThoseOfOneRank) {
  for (const fem::PotentialRule rule :
       {fem::PotentialRule::averaged, fem::PotentialRule::consistent, fem::PotentialRule::nodal}) {
    CahnHilliardModel model = make_model();
    model.rule = rule;
    model.effects = {prescribed_density(
        "g", Slot::source,
        [](const fem::QuadraturePoint& at, double t) { return at.x[0] * at.x[1] + t * at.x[2]; })};
    const auto whole = make_space(kCells);
    const CahnHilliard problem(whole, model);
    struct Parts {
      std::map<std::int64_t, double> first, second, product_first, product_second;
      std::map<std::int64_t, Row> cc, cm, mc, mm;
    };
    const auto evaluate = [](const CahnHilliard& p, linear::Tangent tangent) {
      const fem::SurfaceSpace& space = p.space();
      const int n = p.block_size();
      const Vec y = state_on(space, 5), ydot = state_on(space, 6), v = state_on(space, 7);
      Vec r(2 * n), product(2 * n), assembled(2 * n);
      linear::BlockJacobian J = p.make_jacobian();
      EXPECT_TRUE(p.residual(0.3, y, ydot, r).ok());
      EXPECT_TRUE(p.jacobian(0.3, y, ydot, 4.0, tangent, J).ok());
      EXPECT_TRUE(p.jacobian_product(0.3, y, ydot, 4.0, tangent, v, product).ok());
      J.multiply(v, assembled, *space.team);
      EXPECT_LT((assembled - product).cwiseAbs().maxCoeff(), 1e-11);
      return Parts{entries_of(space, r.head(n)),
                   entries_of(space, r.tail(n)),
                   entries_of(space, product.head(n)),
                   entries_of(space, product.tail(n)),
                   rows_of(space, J.cc),
                   rows_of(space, J.cm),
                   rows_of(space, J.mc),
                   rows_of(space, J.mm)};
    };
    for (const linear::Tangent tangent : {linear::Tangent::exact, linear::Tangent::stabilised}) {
      const Parts expected = evaluate(problem, tangent);
      run_on_ranks(GetParam(), [&](const auto& ranks) {
        const Parts part = evaluate(CahnHilliard(part_of(ranks), model), tangent);
        expect_entries_within(part.first, expected.first, "F1");
        expect_entries_within(part.second, expected.second, "F2");
        expect_entries_within(part.product_first, expected.product_first, "Jv, first half");
        expect_entries_within(part.product_second, expected.product_second, "Jv, second half");
        expect_rows_within(part.cc, expected.cc, "cc");
        expect_rows_within(part.cm, expected.cm, "cm");
        expect_rows_within(part.mc, expected.mc, "mc");
        expect_rows_within(part.mm, expected.mm, "mm");
      });
    }
  }
}

// Some solve systems of their own, or sum over the surface: to the accuracy of that.
TEST_P(Distribution, EffectsAreThoseOfOneRank) {
  const auto whole = make_space(kCells);
  for (const std::string& effect : testing::kStrong) {
    const auto evaluate = [&](const std::shared_ptr<const fem::SurfaceSpace>& of) {
      CahnHilliardModel model = make_model();  // ranks share nothing, as processes do
      effects::add_effects(effect, {1, 1, true}, model);
      const CahnHilliard p(of, model);
      const fem::SurfaceSpace& space = *of;
      const Vec y = state_on(space, 5), ydot = state_on(space, 6), v = state_on(space, 7);
      Vec r(p.size()), product(p.size());
      EXPECT_TRUE(p.residual(0.3, y, ydot, r).ok());
      EXPECT_TRUE(p.jacobian_product(0.3, y, ydot, 4.0, linear::Tangent::exact, v, product).ok());
      std::vector<std::map<std::int64_t, double>> all;
      for (const Vec& both : {r, product})
        for (const bool first : {true, false})
          all.push_back(
              entries_of(space, first ? both.head(p.block_size()) : both.tail(p.block_size())));
      return std::pair(all, p.energy(y));
    };
    const auto expected = evaluate(whole);
    run_on_ranks(GetParam(), [&](const auto& ranks) {
      const auto part = evaluate(part_of(ranks));
      EXPECT_NEAR(part.second, expected.second, 1e-9 * std::fabs(expected.second)) << effect;
      for (std::size_t k = 0; k < part.first.size(); ++k)
        for (const auto& [id, value] : part.first[k])
          EXPECT_NEAR(value, expected.first[k].at(id), 1e-9)
              << effect << ", " << k << ", node " << id;
    });
  }
}

TEST_P(Distribution, InitialStatesAreTheSame) {
  for (const std::string initial : {"noise", "band-limited", "caps"}) {
    InitialRequest request;
    request.raft_fraction = 0.3;
    request.noise_cells = 10;
    request.caps = {{Point(1, 0.3, 0.2), 0.6}};
    const auto whole = make_space(kCells);
    const auto expected = entries_of(*whole, make_initial_field(initial, *whole, request));
    run_on_ranks(GetParam(), [&](const auto& ranks) {
      const auto part = part_of(ranks);
      for (const auto& [id, c] : entries_of(*part, make_initial_field(initial, *part, request)))
        EXPECT_NEAR(c, expected.at(id), 1e-11) << initial;
    });
  }
}

TEST_P(Distribution, ConsistentStatesNormsAndObservablesAreTheSame) {
  const auto whole = make_space(kCells);
  const CahnHilliard problem(whole, make_model("degenerate", 0.1));
  const auto start = noise_state(problem, 3, 0.4);
  const double interface_energy = problem.model().well.interface_energy();
  const observables::Observer observer(problem, whole, interface_energy);
  const observables::Observables expected = observer.measure(0, start.y);
  const observables::RaftReport rafts = observer.rafts(start.y);
  const Vec values = fem::trace(*whole, problem.c_of(start.y));
  const observables::Image picture = observables::draw_front_and_back(*whole, values, 0, 1, 40);
  run_on_ranks(GetParam(), [&](const auto& ranks) {
    const auto part = part_of(ranks);
    const CahnHilliard mine(part, make_model("degenerate", 0.1));
    const auto my_start = noise_state(mine, 3, 0.4);
    EXPECT_NEAR(mine.norm(my_start.y), problem.norm(start.y), 1e-11);
    EXPECT_NEAR(mine.field_norm(my_start.ydot.head(mine.block_size())),
                problem.field_norm(start.ydot.head(problem.block_size())), 1e-6);
    const observables::Observer my_observer(mine, part, interface_energy);
    const observables::Observables row = my_observer.measure(0, my_start.y);
    EXPECT_NEAR(row.mass, expected.mass, 1e-11);
    EXPECT_NEAR(row.energy, expected.energy, 1e-11);
    EXPECT_NEAR(row.perimeter, expected.perimeter, 1e-6);
    EXPECT_NEAR(row.perimeter_level, expected.perimeter_level, 1e-7);
    EXPECT_EQ(row.rafts, expected.rafts);
    EXPECT_NEAR(row.raft_fraction, expected.raft_fraction, 1e-9);
    EXPECT_NEAR(row.c_min, expected.c_min, 1e-10);
    EXPECT_NEAR(row.c_max, expected.c_max, 1e-10);
    const observables::RaftReport my_rafts = my_observer.rafts(my_start.y);
    ASSERT_EQ(my_rafts.rafts.size(), rafts.rafts.size());
    for (std::size_t k = 0; k < rafts.rafts.size(); ++k) {
      EXPECT_NEAR(my_rafts.rafts[k].area, rafts.rafts[k].area, 1e-9);
      EXPECT_LT((my_rafts.rafts[k].centre - rafts.rafts[k].centre).norm(), 1e-9);
    }
    Vec buffer;
    const Vec my_values = fem::trace(*part, part->with_ghosts(mine.c_of(my_start.y), buffer));
    const observables::Image mine_drawn =
        observables::draw_front_and_back(*part, my_values, 0, 1, 40);
    ASSERT_EQ(mine_drawn.rgb.size(), picture.rgb.size());
    int different = 0;
    for (std::size_t i = 0; i < picture.rgb.size(); ++i)
      different += std::abs(mine_drawn.rgb[i] - picture.rgb[i]) > 2;
    EXPECT_LT(different, static_cast<int>(picture.rgb.size() / 200));
  });
}

std::vector<std::pair<int, std::function<double(const Point&)>>> fields_of_rafts() {
  const auto angle = [](const Point& x) { return std::acos(x[2] / x.norm()); };
  const auto turn = [](const Point& x) { return std::atan2(x[1], x[0]); };
  return {{1, [=](const Point& x) { return 0.5 + 0.45 * std::sin(6 * angle(x) + turn(x)); }},
          {3,
           [=](const Point& x) {
             return 0.4 + 0.45 * std::sin(angle(x)) * std::sin(4 * angle(x) + 3 * turn(x));
           }},
          {1, [](const Point& x) { return 0.8 - std::fabs(x[2]); }},
          {4, [](const Point& x) { return 0.45 + x[0] * x[1] * x[2]; }}};
}

Vec at_nodes(const fem::SurfaceSpace& space, const std::function<double(const Point&)>& f) {
  Vec c(space.nodes());
  for (int i = 0; i < space.nodes(); ++i) c[i] = f(space.mesh.position(i));
  return c;
}

using NodePair = std::pair<std::int64_t, std::int64_t>;
NodePair place_of(const fem::SurfaceSpace& space, int point) {
  const mesh::CutPoint& cut = space.surface.points[point];
  return {space.mesh.node_id[cut.low], space.mesh.node_id[cut.high]};
}

// Spirals over all ranks, a ring, and rafts that are equally large.
TEST_P(Distribution, RaftsAreTheSameAndHaveTheSameNumbers) {
  const auto whole = make_space(kCells);
  for (const auto& [count, field] : fields_of_rafts()) {
    const observables::RaftReport rafts =
        observables::RaftFinder(whole).find(at_nodes(*whole, field), 0.5);
    EXPECT_EQ(static_cast<int>(rafts.rafts.size()), count);
    std::map<NodePair, int> numbers;
    for (std::size_t p = 0; p < rafts.of_point.size(); ++p)
      numbers[place_of(*whole, static_cast<int>(p))] = rafts.of_point[p];
    run_on_ranks(GetParam(), [&, &f = field](const auto& ranks) {
      const auto part = part_of(ranks);
      const observables::RaftReport mine =
          observables::RaftFinder(part).find(at_nodes(*part, f), 0.5);
      EXPECT_NEAR(mine.perimeter / rafts.perimeter, 1, 1e-12);
      ASSERT_EQ(mine.rafts.size(), rafts.rafts.size());
      for (std::size_t k = 0; k < rafts.rafts.size(); ++k) {
        EXPECT_LT((mine.rafts[k].centre - rafts.rafts[k].centre).norm(), 1e-12) << k;
        EXPECT_NEAR(mine.rafts[k].distance, rafts.rafts[k].distance, 1e-12) << k;
      }
      for (std::size_t t = 0; t < part->surface.triangles.size(); ++t) {
        if (!part->owns_triangle(t)) continue;
        for (const int p : part->surface.triangles[t])
          ASSERT_EQ(mine.of_point[p], numbers.at(place_of(*part, p)));
      }
    });
  }
}

// A checkpoint does not depend on the number of ranks that write it, nor on those that read it.
TEST_P(Distribution, CheckpointsAreWrittenAndReadOnAnyNumberOfRanks) {
  const auto whole = make_space(kCells);
  const Vec expected = state_on(*whole, 9);
  std::ostringstream one;
  write_binary(CheckpointOut(one, whole->order), 3.5);
  write_binary(CheckpointOut(one, whole->order), expected);
  write_binary(CheckpointOut(one, whole->order), true);
  run_on_ranks(GetParam(), [&](const auto& ranks) {
    const auto part = part_of(ranks);
    const Vec mine = state_on(*part, 9);
    std::ostringstream out;
    write_binary(CheckpointOut(out, part->order), 3.5);
    write_binary(CheckpointOut(out, part->order), mine);
    write_binary(CheckpointOut(out, part->order), true);
    EXPECT_EQ(out.str(), ranks->root() ? one.str() : "");
    std::istringstream in(ranks->root() ? one.str() : "");
    double number = 0;
    bool flag = false;
    Vec read;
    read_binary(CheckpointIn(in, part->order), number);
    read_binary(CheckpointIn(in, part->order), read, mine.size());
    read_binary(CheckpointIn(in, part->order), flag);
    EXPECT_EQ(number, 3.5);
    EXPECT_EQ(read, mine);
    EXPECT_TRUE(flag);
  });
}

TEST_P(Distribution, MassIsRestoredAndNormsAreTakenOverAllRanks) {
  const CahnHilliardModel model = make_model();
  const auto evaluate = [&](const std::shared_ptr<const fem::SurfaceSpace>& space) {
    const CahnHilliard problem(space, model);
    linear::BlockJacobian J = problem.make_jacobian();
    const Vec y = state_on(*space, 5), b = state_on(*space, 8);
    EXPECT_TRUE(problem.jacobian(0, y, Vec::Zero(y.size()), 4.0, linear::Tangent::exact, J).ok());
    Vec x = state_on(*space, 10);
    linear::restore_mass(J, b, x);
    return std::pair(space->integral(x.head(space->nodes())), linear::scaled_norm(J, b));
  };
  const auto expected = evaluate(make_space(kCells));
  run_on_ranks(GetParam(), [&](const auto& ranks) {
    const auto found = evaluate(part_of(ranks));
    EXPECT_NEAR(found.first, expected.first, 1e-13 * std::fabs(expected.first));
    EXPECT_NEAR(found.second, expected.second, 1e-12 * expected.second);
  });
}

TEST_P(Distribution, AMeshThatIsTooCoarseIsRefusedAlike) {
  const auto complaint = [](const std::function<void()>& action) {
    try {
      action();
      return std::string();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  const auto build = [](std::shared_ptr<const Communicator> ranks) {
    fem::SurfaceSpace(geometry::make_surface("dziuk"), 10, std::make_shared<ThreadTeam>(1),
                      std::move(ranks));
  };
  const std::string expected = complaint([&] { build(std::make_shared<SerialCommunicator>()); });
  ASSERT_NE(expected.find("too coarse"), std::string::npos);
  run_on_ranks(GetParam(),
               [&](const auto& ranks) { EXPECT_EQ(complaint([&] { build(ranks); }), expected); });
}

INSTANTIATE_TEST_SUITE_P(Ranks, Distribution, ::testing::Values(1, 2, 3, 5),
                         [](const auto& test) { return "On" + std::to_string(test.param); });

}  // namespace
}  // namespace traceraft::problem
