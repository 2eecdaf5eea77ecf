// Typing mistakes of users, in all commands.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;

struct Refusal {
  const char *arguments, *expected;
};
std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {  // the name of its test
  return out << "traceraft " << refusal.arguments;
}

// Bad input: exit 2, one line that names the place, and no folder.
class BadInput : public ::testing::TestWithParam<Refusal> {
 protected:
  testing::TemporaryFolder folder;
};

TEST_P(BadInput, IsAnsweredInOneLineBeforeAnyFolderIsMade) {
  const auto [arguments, expected] = GetParam();
  const testing::ProgramEnd run = testing::shell(
      "cd " + folder.path.string() +
      " && printf 'cells = 16\\ncells = 8\\n' > "
      "twice.toml && printf 'epsilon = nan\\n' > nan.toml && printf 'cells = \"x\"\\n' > type.toml "
      "&& head -c 3000000 "
      "/dev/zero > huge.toml && (yes a. | head -87000 | tr -d '\\n' && echo 'b = 1') > deep.toml "
      "&& head -c 3000 /dev/urandom > binary.toml && " +
      TRACERAFT_PROGRAM + " " + arguments);
  EXPECT_TRUE(testing::refuses(run, expected));
  EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
  EXPECT_FALSE(fs::exists(folder.path / "runs"));
  EXPECT_FALSE(fs::exists(folder.path / "new"));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadInput,
    ::testing::Values(
        Refusal{"run --cels 16", "'--cells'"}, Refusal{"run --cells=16 --seeed=3", "'--seed'"},
        Refusal{"run surplus", "'surplus'"}, Refusal{"verify list mass", "list"},
        Refusal{"verify geometry --quick --document report", "--document"}, Refusal{"rum", "'run'"},
        Refusal{"", "traceraft"}, Refusal{"resume", "resume"}, Refusal{"resume missing", "missing"},
        Refusal{"resume .", "config.toml"}, Refusal{"run --cells", "--cells"},
        Refusal{"run --cells abc", "--cells: 'abc'"}, Refusal{"run --cells 3", "4 to 4096"},
        Refusal{"run --epsilon nan", "--epsilon: 'nan'"},
        Refusal{"fraction --composition 3:1:20 --temperature nan", "--temperature: 'nan'"},
        Refusal{"report runs --detail nan", "--detail: 'nan'"},
        Refusal{"campaign --seed -3", "--seed: -3"}, Refusal{"hide --blur -1", "--blur: -1"},
        Refusal{"hide --first 0", "--first: 0"}, Refusal{"hide --points 1e4", "--points: '1e4'"},
        Refusal{"ensemble --out new", "--out: new"}, Refusal{"run --epsilon -1", "--epsilon: -1"},
        Refusal{"run --case guv", "'guv-2to1'"},
        Refusal{"run --model discs --effect flow:capillary=5", "Brownian"},
        Refusal{"run --model discs --effect flow:thermal=1e-3,hold=1", "hold"},
        Refusal{"run --cells 8 --surface biconcave", "16"},
        Refusal{"run --config missing.toml", "--config: "},
        Refusal{"run --config twice.toml", "twice.toml:2"},
        Refusal{"run --config nan.toml --epsilon 1", "nan.toml:1"},
        Refusal{"run --out= --quiet", "--out: it is empty"},
        Refusal{"run --output-times 0.01,", "--output-times: a number is missing"},
        Refusal{"run --config type.toml", "type.toml:1: cells"},
        Refusal{"run --config huge.toml", "huge.toml"},
        Refusal{"run --config binary.toml", "binary.toml"}, Refusal{"run --config .", "--config"},
        Refusal{"run --cells 16 --cells 8", "--cells"}, Refusal{"run --seed 1.5", "--seed: '1.5'"},
        Refusal{"run --fields=perhaps", "true or false"},
        Refusal{"run --initial restart:", "--initial: restart"},
        Refusal{"run --ida-maxord 2.5", "--ida-maxord: '2.5'"},
        Refusal{"run --ida-maxstep 1e-4 --min-step 0.01", "--ida-maxstep"},
        Refusal{"run --initial noise --initial-caps '0 0 1 40'", "--initial-caps: "},
        Refusal{"run --surface formula --surface-formula 1-x^2-y^2-z^2", "--surface: "},
        Refusal{"run --linear-solver klu", "--linear-solver: klu"},
        Refusal{"run --energy-guard reject --potential nodal", "--energy-guard: reject"},
        Refusal{"verify everything", "'everything'"},
        // A shell script leaves this where a variable is not set.
        Refusal{"run --config ''", "--config: "}, Refusal{"run --out ''", "--out: "},
        Refusal{"run --linear-solver teko --teko-parameters ''", "--teko-parameters: "},
        Refusal{"run --output-times ''", "--output-times: "},
        Refusal{"run --output-times 0.1,,0.2", "--output-times: "},
        Refusal{"resume ''", "folder: "}, Refusal{"report ''", "folder: "},
        Refusal{"data check ''", "folder: "},
        Refusal{"data compare . --ensemble ''", "--ensemble: "},
        Refusal{"verify mass --document ''", "--document: "},
        Refusal{"compare --references ''", "--references: "},
        Refusal{"hide --model ''", "--model: "},
        Refusal{"campaign --elsewhere ''", "--elsewhere: "},
        Refusal{"explain --data ''", "--data: "}, Refusal{"calibrate --data ''", "--data: "},
        // Whole numbers that a double does not hold.
        Refusal{"run --seed 9007199254740993", "--seed: 9007199254740993"},
        Refusal{"hide --seed 9007199254740993", "--seed: 9007199254740993"},
        Refusal{"ensemble --first-seed 9007199254740993", "--first-seed: 9007199254740993"},
        Refusal{"ensemble --case guv-2to1 --first-seed 9007199254740990 --out new",
                "9007199254740999"},
        Refusal{"run --config deep.toml", "deep.toml:1"},
        Refusal{"run --t-end 1e-300", "--t-end: 1e-300"},
        Refusal{"run --cells 16 --initial formula --initial-formula x=1", "'x=1'"},
        Refusal{"run --cells 16 --surface formula --surface-formula '(x^2+y^2+z^2-1)^3'",
                "(0.577, 0.577, 0.577)"},
        Refusal{"run --cells 16 --initial formula --initial-formula 'log(z-0.5)'", "finite at ("}));

}  // namespace
}  // namespace traceraft
