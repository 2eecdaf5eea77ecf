// The promises of every linear solver (kernel/linear/linear_solver.hpp).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <sstream>

#include "backends/list.hpp"
#include "backends/suitesparse/direct_solver.hpp"
#include "backends/suitesparse/supernodal_solver.hpp"
#include "backends/sundials/spfgmr.hpp"
#include "kernel/linear/block_solver.hpp"
#include "kernel/linear/setup_policy.hpp"
#include "kernel/linear/two_solve_preconditioner.hpp"
#include "tests/support/dense.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft::linear {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;
using testing::random_vector;

class LinearSolverContract : public ::testing::TestWithParam<std::string> {
 protected:
  LinearSolverContract()
      : space(make_space(16)),
        problem(space, make_model("degenerate", 0.1)),
        solver(backends::linear_solvers().find(GetParam()).make(*space, {})(1)),
        J(problem.make_jacobian()) {}

  void assemble(double shift, std::uint64_t seed = 1, Tangent tangent = Tangent::stabilised) {
    const testing::StartState start = noise_state(problem, seed);
    ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, shift, tangent, J).ok());
  }
  double relative_residual(const Vec& b, const Vec& x) const {
    Vec product(b.size());
    J.multiply(x, product, *space->team);
    return scaled_norm(J, b - product) / scaled_norm(J, b);
  }

  std::shared_ptr<const fem::SurfaceSpace> space;
  problem::CahnHilliard problem;
  LinearSolverPtr solver;
  BlockJacobian J;
};

TEST_P(LinearSolverContract, SolvesOverManyStepSizesWithBothTangents) {
  const Vec b = random_vector(problem.size(), 3);
  // The state is noise far inside the spinodal, which grows at some σ = 10: with the exact tangent
  // the Jacobian of longer steps is indefinite, and no integrator takes them.
  for (const auto& [tangent, smallest] :
       {std::pair(Tangent::stabilised, 1e-4), std::pair(Tangent::exact, 10.0)})
    for (double shift = 1e5; shift > 0.9 * smallest; shift /= 10) {
      assemble(shift, 1, tangent);
      ASSERT_TRUE(solver->setup(J).ok());
      Vec x = Vec::Zero(b.size());
      const SolveReport report = solver->solve(J, b, x, 1e-8);
      ASSERT_TRUE(report.status.ok()) << report.status.why;
      EXPECT_LE(relative_residual(b, x), 1.01e-8) << "shift " << shift;
      // A V-cycle stands for a factorisation with some loss. The exact tangent of the longest step
      // takes 31 with 0.3 h S in M̃, and 19 with h S (docs/decisions/0019).
      const bool hard = GetParam() == "teko" || (tangent == Tangent::exact && shift < 11);
      EXPECT_LE(report.iterations, hard ? 35 : 20) << "shift " << shift;
    }
}

TEST_P(LinearSolverContract, SolvesNothingWithoutFactors) {
  assemble(50);
  const Vec b = random_vector(problem.size(), 3);
  Vec x = Vec::Zero(b.size());
  EXPECT_TRUE(solver->wants_setup(J));
  EXPECT_EQ(solver->solve(J, b, x, 1e-8).status.outcome, Outcome::retry);
}

TEST_P(LinearSolverContract, SaysSoWhenItCannotReachATolerance) {
  assemble(50);
  ASSERT_TRUE(solver->setup(J).ok());
  const Vec b = random_vector(problem.size(), 3);
  Vec x = Vec::Zero(b.size());
  const SolveReport report = solver->solve(J, b, x, 1e-30);
  EXPECT_EQ(report.status.outcome, Outcome::retry);
  EXPECT_FALSE(report.status.why.empty());
}

TEST_P(LinearSolverContract, KeepsTheMassOfTheRightHandSide) {
  for (const double tolerance : {1e-2, 1e-8}) {
    assemble(50);
    ASSERT_TRUE(solver->setup(J).ok());
    const Vec b = random_vector(problem.size(), 4);
    Vec x = Vec::Zero(b.size());
    ASSERT_TRUE(solver->solve(J, b, x, tolerance).status.ok());
    const int n = problem.block_size();
    // 1ᵀ(σ M̃ δc + A δμ) = σ ∫δc
    EXPECT_NEAR(J.shift * space->integral(x.head(n)), b.head(n).sum(),
                1e-12 * b.head(n).cwiseAbs().sum());
  }
}

TEST_P(LinearSolverContract, UsesOlderFactorsOnlyWhenItSaysSo) {
  assemble(50);
  ASSERT_TRUE(solver->setup(J).ok());
  const Vec b = random_vector(problem.size(), 5);
  assemble(60, 2);  // another state and step
  if (solver->wants_setup(J)) {
    ASSERT_TRUE(solver->setup(J).ok());
  }
  Vec x = Vec::Zero(b.size());
  ASSERT_TRUE(solver->solve(J, b, x, 1e-8).status.ok());
  EXPECT_LE(relative_residual(b, x), 1.01e-8);
}

TEST_P(LinearSolverContract, AcceptsAZeroRightHandSideAndAGoodGuess) {
  assemble(50);
  ASSERT_TRUE(solver->setup(J).ok());
  Vec b = Vec::Zero(problem.size()), x = random_vector(problem.size(), 6);
  ASSERT_TRUE(solver->solve(J, b, x, 1e-8).status.ok());
  EXPECT_LT(x.norm(), 1e-12);
  const Vec exact = random_vector(problem.size(), 7);
  J.multiply(exact, b, *space->team);
  x = exact;
  const SolveReport report = solver->solve(J, b, x, 1e-8);
  ASSERT_TRUE(report.status.ok());
  EXPECT_LE(report.iterations, 1);
  EXPECT_LT((x - exact).norm(), 1e-6 * exact.norm());
}

TEST_P(LinearSolverContract, NeverReportsAWrongSolutionAsGood) {
  assemble(50);
  // Singular: the first block row is zero.
  std::fill(J.cc.values.begin(), J.cc.values.end(), 0.0);
  std::fill(J.cm.values.begin(), J.cm.values.end(), 0.0);
  const Vec b = random_vector(problem.size(), 8);
  Vec x = Vec::Zero(b.size());
  bool solved = solver->setup(J).ok() && solver->solve(J, b, x, 1e-8).status.ok();
  EXPECT_FALSE(solved);
  // Not finite.
  assemble(50);
  J.cm.values[7] = std::nan("");
  solved = solver->setup(J).ok() && solver->solve(J, b, x, 1e-8).status.ok();
  EXPECT_FALSE(solved);
  assemble(50);
  ASSERT_TRUE(solver->setup(J).ok()) << "a failure must not outlive its matrix";
  Vec poisoned = b;
  poisoned[3] = std::nan("");
  EXPECT_FALSE(solver->solve(J, poisoned, x, 1e-8).status.ok());
  x.setZero();
  EXPECT_TRUE(solver->solve(J, b, x, 1e-8).status.ok());
}

TEST_P(LinearSolverContract, CountsWhatItDoes) {
  assemble(50);
  ASSERT_TRUE(solver->setup(J).ok());
  Vec b = random_vector(problem.size(), 9), x = Vec::Zero(b.size());
  ASSERT_TRUE(solver->solve(J, b, x, 1e-8).status.ok());
  const LinearStatistics statistics = solver->statistics();
  EXPECT_EQ(statistics.setups, 1);
  EXPECT_EQ(statistics.solves, 1);
  std::stringstream saved;
  solver->save(saved);
  LinearSolverPtr other = backends::linear_solvers().find(GetParam()).make(*space, {})(1);
  other->load(saved);
  EXPECT_EQ(other->statistics().iterations, statistics.iterations);
  EXPECT_EQ(other->statistics().setup_seconds, statistics.setup_seconds);
}

INSTANTIATE_TEST_SUITE_P(All, LinearSolverContract,
                         ::testing::ValuesIn(backends::built_linear_solvers()));

// Factors that are off by a factor.
class Inexact final : public suitesparse::SparseLu {
 public:
  explicit Inexact(double factor) : factor_(factor) {}
  Status factorise(suitesparse::AssembledSystem& system, const std::vector<int>& order) override {
    return lu_->factorise(system, order);
  }
  Status solve(suitesparse::AssembledSystem& system, const Vec& right, Vec& solution) override {
    const Status status = lu_->solve(system, right, solution);
    solution *= factor_;
    return status;
  }

 private:
  double factor_;
  std::unique_ptr<suitesparse::SparseLu> lu_ = suitesparse::make_umfpack_lu();
};

// A Krylov method that says what it is told to, of an iterate that is off by a factor.
class Mistaken final : public KrylovMethod {
 public:
  Mistaken(int size, double factor, Status said)
      : factor_(factor), said_(std::move(said)), method_(sundials::make_spfgmr(size)) {}
  SolveReport solve(const LinearOperator& A, const LinearOperator& preconditioner, VecView b,
                    VecRef x, double tolerance, int max_iterations) override {
    SolveReport report = method_->solve(A, preconditioner, b, x, 0.01 * tolerance, max_iterations);
    x *= factor_;
    report.status = said_;
    return report;
  }

 private:
  double factor_;
  Status said_;
  std::unique_ptr<KrylovMethod> method_;
};

// Only the explicit residual decides.
TEST(BlockSolver, DoesNotTakeItsKrylovMethodAtItsWord) {
  const auto space = make_space(12);
  const problem::CahnHilliard problem(space, make_model("degenerate", 0.1));
  const auto size = static_cast<int>(problem.size());
  BlockJacobian J = problem.make_jacobian();
  const testing::StartState start = noise_state(problem, 1);
  ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, 50, Tangent::stabilised, J).ok());
  const Vec b = random_vector(size, 2);
  const auto solves = [&](double factor, const Status& said) {
    const LinearSolverPtr solver = make_block_solver(
        suitesparse::supernodal_factory(space->pattern),
        [&] { return std::make_unique<Mistaken>(size, factor, said); }, space->team, 1);
    EXPECT_TRUE(solver->setup(J).ok());
    Vec x = Vec::Zero(size);
    return solver->solve(J, b, x, 1e-6).status;
  };
  EXPECT_TRUE(solves(1, {}).ok());
  EXPECT_TRUE(solves(1, Status::retry("it stagnates")).ok());
  EXPECT_EQ(solves(1 + 1e-4, {}).outcome, Outcome::retry);
  EXPECT_EQ(solves(1 + 1e-4, Status::retry("it stagnates")).why, "it stagnates");
  EXPECT_EQ(solves(std::nan(""), {}).outcome, Outcome::retry);
}

TEST(DirectSolver, RefinesWhereItsFactorsAreNotGoodEnough) {
  const auto space = make_space(12);
  const problem::CahnHilliard problem(space, make_model("degenerate", 0.1));
  BlockJacobian J = problem.make_jacobian();
  const testing::StartState start = noise_state(problem, 1);
  ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, 10, Tangent::exact, J).ok());
  const Vec b = random_vector(problem.size(), 2);
  const auto solves = [&](double factor) {
    const LinearSolverPtr solver = suitesparse::make_direct_solver(
        "inexact", [factor] { return std::make_unique<Inexact>(factor); }, space->pattern, 1);
    EXPECT_TRUE(solver->setup(J).ok());
    Vec x = Vec::Zero(b.size());
    const SolveReport report = solver->solve(J, b, x, 1e-9);
    return report.status.ok() ? report.iterations : 0;
  };
  EXPECT_EQ(solves(1), 1);
  EXPECT_EQ(solves(1 + 1e-6), 2);
  EXPECT_EQ(solves(1 + 1e-4), 3);
  EXPECT_EQ(solves(1.5), 0);
}

TEST(SharedSetup, IsWornByIterationsAndByChanges) {
  SharedSetup setup(2, 5);
  EXPECT_TRUE(setup.worn(1));  // there is none yet
  setup.begin(1);
  EXPECT_TRUE(setup.worn(1));  // it has not succeeded
  setup.succeed();
  for (const double shift : {0.3, 1.0, 3.9}) EXPECT_FALSE(setup.worn(shift)) << shift;
  for (const double shift : {0.25, 4.0, std::nan("")}) EXPECT_TRUE(setup.worn(shift)) << shift;
  setup.count(0, 10);  // the fewest of the lane
  setup.count(0, 12);
  setup.count(1, 20);
  setup.count(1, 22);
  EXPECT_FALSE(setup.worn(1));  // 4 extra
  setup.count(1, 21);
  EXPECT_TRUE(setup.worn(1));  // 5, the price of a new one
  setup.begin(1);
  setup.succeed();
  EXPECT_FALSE(setup.worn(1));
}

// Where the roots are complex both shifts stand for √(σ/(m ε²)) with a mobility below the mean, by
// at most a factor of four, and by none at the critical σ and far above it.
TEST(TwoSolve, ComplexRootsUseASmallerMobility) {
  const double mean = 0.2, e2 = 0.01, beta = 1, critical = mean * beta * beta / (4 * e2);
  for (const auto& [above, share] :
       {std::pair(1.0001, 1.0), std::pair(2.0, 0.5), std::pair(10.0, 0.25), std::pair(100.0, 0.25),
        std::pair(200.0, 0.5), std::pair(1e4, 1.0)}) {
    const double sigma = above * critical, m = share * mean;
    const TwoSolveShifts shifts = two_solve_shifts(sigma, mean, e2, beta);
    EXPECT_NEAR(shifts.p / std::sqrt(sigma * m / e2), 1, 1e-3) << above;
    EXPECT_NEAR((beta - shifts.q) / std::sqrt(sigma * e2 / m), 1, 1e-3) << above;
  }
}

TEST(TwoSolve, ShiftsAreTheRootsTheyStandFor) {
  for (double sigma = 1e-6; sigma < 1e6; sigma *= 7) {
    const double m = 0.2, e2 = 1e-4, beta = 1;
    const TwoSolveShifts shifts = two_solve_shifts(sigma, m, e2, beta);
    const double r1 = shifts.p / m, r2 = (beta - shifts.q) / e2;
    EXPECT_NEAR(r1 * r2 / (sigma / (m * e2)), 1, 1e-12);
    if (beta * beta > 4 * sigma * e2 / m) {
      EXPECT_NEAR((r1 + r2) * e2 / beta, 1, 1e-12);
    }
    EXPECT_GE(shifts.p, 0);
  }
}

// Dense Cholesky: exact to roundoff, and checkable by hand.
class DenseSolver final : public SpdSolver {
 public:
  Status factorise(const fem::CsrMatrix& A) override {
    factor_.compute(testing::dense(A));
    return factor_.info() == Eigen::Success ? Status{} : Status::retry("not positive definite");
  }
  void solve(VecView b, VecRef x, const ThreadTeam&, int) override { x = factor_.solve(b); }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

TEST(TwoSolve, IsTheExactInverseForConstantMobilityAndRealRoots) {
  const auto space = make_space(12);
  const problem::CahnHilliard problem(space, make_model("constant:value=0.25", 0.2));
  const testing::StartState start = noise_state(problem);
  BlockJacobian J = problem.make_jacobian();
  TwoSolvePreconditioner inverse([](int) { return std::make_unique<DenseSolver>(); }, 1);
  const Vec b = random_vector(problem.size(), 2);
  for (const double shift : {1.0, 0.01, 100.0}) {
    ASSERT_TRUE(problem.jacobian(0, start.y, start.ydot, shift, Tangent::stabilised, J).ok());
    ASSERT_TRUE(inverse.setup(J, *space->team).ok());
    Vec x(b.size()), back(b.size());
    inverse.apply(J, b, x, *space->team, 0);
    J.multiply(x, back, *space->team);
    const bool real_roots = J.curvature * J.curvature > 4 * shift * J.stiffness / J.mobility;
    EXPECT_EQ(real_roots, shift <= 1);
    const double defect = (back - b).norm() / b.norm();
    if (real_roots) {
      EXPECT_LT(defect, 1e-10) << shift;
    } else {
      EXPECT_GT(defect, 1e-3) << shift;
    }
  }
}

TEST(SupernodalSolver, SolvesToThePrecisionOfItsCopyOnEveryLane) {
  const auto space = make_space(24);
  const fem::CsrMatrix A = fem::combine(1, space->stabilised_mass, 0.01, space->stiffness);
  const SpdSolverPtr solver = suitesparse::supernodal_factory(space->pattern)(2);
  DenseSolver reference;
  ASSERT_TRUE(solver->factorise(A).ok());
  ASSERT_TRUE(reference.factorise(A).ok());
  const Vec b = random_vector(space->nodes(), 3);
  Vec expected(b.size()), first(b.size()), second(b.size());
  const ThreadTeam one(1), two(2), three(3);
  reference.solve(b, expected, one, 0);
  solver->solve(b, first, one, 0);
  solver->solve(b, second, two, 1);
  // Eight significant bits: 0.4 % of each number of the factor.
  EXPECT_LT((first - expected).norm(), 1e-2 * expected.norm());
  EXPECT_EQ(first, second);
  solver->solve(b, second, three, 0);
  EXPECT_EQ(first, second);
  fem::CsrMatrix indefinite = A;
  for (const int k : space->pattern->diagonal) indefinite.values[k] *= -1;
  EXPECT_EQ(solver->factorise(indefinite).outcome, Outcome::retry);
  ASSERT_TRUE(solver->factorise(A).ok());
  solver->solve(b, second, two, 1);
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace traceraft::linear
