// The options of --linear-solver teko: what is wrong is said of the flag, what is right has an
// effect.
#include <gtest/gtest.h>

#include <sstream>

#include "backends/list.hpp"
#include "backends/posix/durable_file.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::make_model;
using testing::make_space;
using testing::noise_state;

class TekoOptionsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!backends::linear_solvers().find("teko").built) GTEST_SKIP() << "Trilinos was not built in";
  }
  linear::LinearSolverPtr make(const backends::WordOptions& options) const {
    return backends::linear_solvers().find("teko").make(*space, options)(1);
  }
  std::string file(const std::string& content) const {
    const auto path = folder.path / "list.xml";
    posix::write_durably(path, "<ParameterList>" + content + "</ParameterList>");
    return path.string();
  }
  // The complaint: what is wrong, after the option it is said of.
  std::string complaint(const backends::WordOptions& options) const {
    try {
      (void)make(options);
    } catch (const OptionError& error) {
      return error.option + ": " + error.what();
    }
    return "";
  }
  linear::SolveReport solve(linear::LinearSolver& solver, double shift = 50,
                            double tolerance = 1e-8, double size = 1) const {
    const testing::StartState start = noise_state(problem);
    linear::BlockJacobian J = problem.make_jacobian();
    EXPECT_TRUE(
        problem.jacobian(0, start.y, start.ydot, shift, linear::Tangent::stabilised, J).ok());
    if (solver.wants_setup(J)) {
      EXPECT_TRUE(solver.setup(J).ok());
    }
    Vec x = Vec::Zero(problem.size());
    return solver.solve(J, size * testing::random_vector(problem.size(), 3), x, tolerance);
  }

  testing::TemporaryFolder folder;
  std::shared_ptr<const fem::SurfaceSpace> space = make_space(16);
  problem::CahnHilliard problem{space, make_model("degenerate", 0.1)};
};

TEST_F(TekoOptionsTest, WordsAreRefusedByTheirFlag) {
  EXPECT_NE(complaint({{"renewal", "alwyas"}})
                .find("renewal: unknown renewal 'alwyas'; did you mean "
                      "'always'"),
            std::string::npos);
  EXPECT_EQ(complaint({{"inverse", "mulu"}}).find("inverse: "), 0u);
  EXPECT_EQ(complaint({{"method", "fgmre"}}).find("method: "), 0u);
  EXPECT_EQ(complaint({{"preconditioner", "two"}}).find("preconditioner: "), 0u);
}

// The parser calls itself for every list: the stack was gone.
TEST_F(TekoOptionsTest, ListsWithinTwentyThousandListsAreRefused) {
  std::string lists;
  for (int k = 0; k < 20000; ++k) lists += "<ParameterList name=\"a\">";
  for (int k = 0; k < 20000; ++k) lists += "</ParameterList>";
  EXPECT_NE(complaint({{"parameters", file(lists)}}).find("lists within lists, more than 100"),
            std::string::npos);
}

// Judged without a scale, what is small has converged before it begins.
TEST_F(TekoOptionsTest, ALoosenedTestDoesNotMakeASolution) {
  std::string lists = "<ParameterList name=\"Belos\">";
  for (const char* scaling : {"Implicit Residual Scaling", "Explicit Residual Scaling"})
    lists += "<Parameter name=\"" + std::string(scaling) + "\" type=\"string\" value=\"None\"/>";
  const std::string loose = file(lists + "</ParameterList>");
  const linear::SolveReport report =
      solve(*make({{"method", "gmres"}, {"parameters", loose}}), 50, 1e-8, 1e-12);
  EXPECT_EQ(report.status.outcome, Outcome::retry);
  EXPECT_EQ(report.status.why, "the residual is larger than the method says");
  EXPECT_TRUE(solve(*make({{"method", "gmres"}}), 50, 1e-8, 1e-12).status.ok());
}

TEST_F(TekoOptionsTest, FilesAreCheckedBeforeARunStarts) {
  const auto refused = [&](const std::string& content, const std::string& why) {
    const std::string said = complaint({{"parameters", file(content)}});
    EXPECT_EQ(said.find("parameters: "), 0u) << content;
    EXPECT_NE(said.find(why), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  };
  EXPECT_NE(complaint({{"parameters", "nowhere.xml"}}).find("cannot be read: No such file"),
            std::string::npos);
  refused("<Paramter", "no Teuchos parameter list");
  refused("<ParameterList name=\"Beloss\"/>", "did you mean 'Belos'");
  refused("<Parameter name=\"Belos\" type=\"int\" value=\"1\"/>", "Belos is no sublist");
  refused(
      "<ParameterList name=\"Belos\"><Parameter name=\"Num Bloks\" type=\"int\" value=\"5\"/>"
      "</ParameterList>",
      "did you mean 'Num Blocks'");
  refused(
      "<ParameterList name=\"Belos\"><Parameter name=\"Convergence Tolerance\" type=\"double\" "
      "value=\"0.1\"/></ParameterList>",
      "\"Convergence Tolerance\" is what the integrator asks for");
  refused("<ParameterList name=\"Inverse Library\"><ParameterList name=\"mine\"/></ParameterList>",
          "needs a sublist with the parameter Type");
}

TEST_F(TekoOptionsTest, FilesHaveAnEffect) {
  const std::string few = file(
      "<ParameterList name=\"Belos\"><Parameter name=\"Maximum Iterations\" type=\"int\" "
      "value=\"1\"/></ParameterList>");
  EXPECT_FALSE(solve(*make({{"parameters", few}})).status.ok());
  const std::string mine = file(
      "<ParameterList name=\"Inverse Library\"><ParameterList name=\"mine\">"
      "<Parameter name=\"Type\" type=\"string\" value=\"Ifpack2\"/>"
      "<Parameter name=\"Prec Type\" type=\"string\" value=\"RILUK\"/>"
      "<ParameterList name=\"Ifpack2 Settings\"><Parameter name=\"fact: iluk level-of-fill\" "
      "type=\"int\" value=\"0\"/></ParameterList></ParameterList></ParameterList>");
  const linear::SolveReport own = solve(*make({{"parameters", mine}, {"inverse", "mine"}}));
  const linear::SolveReport other = solve(*make({{"inverse", "ifpack2"}}));
  EXPECT_TRUE(own.status.ok()) << own.status.why;
  EXPECT_GT(own.iterations, other.iterations);
}

TEST_F(TekoOptionsTest, RenewalAlwaysIsASetUpForEverySolve) {
  const linear::LinearSolverPtr always = make({{"renewal", "always"}}), worn = make({});
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(solve(*always).status.ok());
    EXPECT_TRUE(solve(*worn).status.ok());
  }
  EXPECT_EQ(always->statistics().setups, 3);
  EXPECT_EQ(worn->statistics().setups, 1);
}

// A preconditioner is made of vectors one by one: with gcrodr, which brings ten at a time, it is as
// good as with gmres.
TEST_F(TekoOptionsTest, RecyclingNeedsNoMoreIterations) {
  const linear::LinearSolverPtr recycling = make({{"method", "gcrodr"}}),
                                plain = make({{"method", "gmres"}});
  int with = 0, without = 0;
  for (int k = 0; k < 6; ++k) {
    const linear::SolveReport a = solve(*recycling, 0.1, 1e-10), b = solve(*plain, 0.1, 1e-10);
    EXPECT_TRUE(a.status.ok()) << a.status.why;
    with += a.iterations;
    without += b.iterations;
  }
  EXPECT_LE(with, without + 6);
}

// Whatever a method carries from solve to solve: a run that was saved goes on like one that is
// resumed there, bitwise.
TEST_F(TekoOptionsTest, EveryMethodGoesOnAsSaved) {
  for (const char* method : {"fgmres", "gmres", "gcrodr", "bicgstab"}) {
    const auto integrator = [&] {
      return backends::integrators().find("euler").make(
          problem, backends::choose_linear_solver("teko", *space, {{"method", method}}),
          space->team, {});
    };
    const testing::StartState start = noise_state(problem);
    const time::IntegratorPtr one = integrator(), other = integrator();
    ASSERT_TRUE(one->start(0, start.y, start.ydot, 10).ok());
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(one->advance().ok());
    std::stringstream saved;
    one->save(saved);
    other->load(saved);
    for (int k = 0; k < 5; ++k) {
      ASSERT_TRUE(one->advance().ok());
      ASSERT_TRUE(other->advance().ok());
    }
    EXPECT_EQ(one->state(), other->state()) << method;
  }
}

TEST_F(TekoOptionsTest, AnotherFileIsNoticedOnResume) {
  const std::string path = file("<ParameterList name=\"Belos\"/>");
  std::stringstream saved;
  make({{"parameters", path}})->save(saved);
  (void)file(
      "<ParameterList name=\"Belos\"><Parameter name=\"Num Blocks\" type=\"int\" "
      "value=\"7\"/></ParameterList>");
  EXPECT_THROW(make({{"parameters", path}})->load(saved), IoError);
}

}  // namespace
}  // namespace traceraft
