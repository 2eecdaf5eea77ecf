#include "drivers/config/configuration.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/config/cases.hpp"
#include "drivers/config/config_file.hpp"
#include "drivers/run/run_setup.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/random.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

using testing::TemporaryFolder;

config::GivenValues flags(std::initializer_list<std::pair<std::string, std::string>> values) {
  config::GivenValues result;
  for (const auto& [name, text] : values) result[name] = {text, "--" + name};
  return result;
}

template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

config::GivenValues read_text(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "run.toml") << text;  // syncing it 2000 times takes half a minute
  return config::read_config_file(folder.path / "run.toml");
}

TEST(Configuration, FlagsBeatTheFileWhichBeatsTheCaseWhichBeatsDefaults) {
  const config::GivenValues file = read_text("case = \"spinodal\"\ncells = 48\ntolerance = 1e-3\n");
  const config::Configuration c(file, flags({{"tolerance", "1e-4"}}));
  EXPECT_EQ(c.options().tolerance, 1e-4);
  EXPECT_EQ(c.options().cells, 48);
  EXPECT_EQ(c.options().raft_fraction, 0.5);
  EXPECT_EQ(c.options().integrator, "ida");
  EXPECT_EQ(config::Configuration({}, flags({{"integrator", "euler"}})).options().tolerance, 5e-3);
}

// The mesh of a vesicle follows the boundaries, unless another one or other cells are asked for.
TEST(Configuration, TakesTheMeshOfTheCaseAsAWholeOrNotAtAll) {
  struct Chosen {
    config::GivenValues given;
    std::string mesh;
    std::int64_t cells, noise_cells;
    std::string flags;
  };
  for (const auto& [given, mesh, cells, noise_cells, text] :
       {Chosen{{}, "adaptive", 256, 32, ""},
        Chosen{flags({{"mesh", "adaptive"}}), "adaptive", 256, 32, ""},
        Chosen{flags({{"mesh", "uniform"}}), "uniform", 128, 32, "--cells 128"},
        Chosen{flags({{"cells", "64"}}), "uniform", 64, 16, "--cells 64"},
        Chosen{flags({{"cells", "256"}, {"mesh", "uniform"}}), "uniform", 256, 64,
               "--cells 256 --mesh uniform"},
        Chosen{flags({{"mesh", "adaptive"}, {"cells", "128"}}), "adaptive", 128, 32,
               "--cells 128 --mesh adaptive"},
        Chosen{flags({{"noise-cells", "64"}}), "adaptive", 256, 64, "--noise-cells 64"},
        Chosen{flags({{"cells-per-boundary", "2.3"}}), "uniform", 128, 32, "--cells 128"},
        Chosen{flags({{"case", "spinodal"}, {"mesh", "adaptive"}}), "adaptive", 64, 64,
               "--case spinodal --mesh adaptive"}}) {
    const config::Configuration c({}, given);
    EXPECT_EQ(c.options().mesh, mesh) << text;
    EXPECT_EQ(c.options().cells, cells) << text;
    EXPECT_EQ(c.noise_cells(), noise_cells) << text;
    EXPECT_EQ(config::flags_text(c), text);
    const config::Configuration kept(read_text(config::config_text(c)), {});
    EXPECT_EQ(config::numerical_identity(kept), config::numerical_identity(c));
  }
  const config::Configuration of_file(read_text("cells = 48\n"), {});
  EXPECT_EQ(of_file.options().mesh, "uniform");
  const config::Configuration equal(config::uniform_mesh(), {});
  EXPECT_EQ(equal.options().cells, 128);
  EXPECT_FALSE(equal.from_flag("mesh"));
}

TEST(Configuration, KnowsTheFlagsThatRepeatIt) {
  EXPECT_EQ(config::flags_text(config::Configuration({}, {})), "");
  const config::Configuration given(read_text("case = \"guv-3to1\"\ncells = 48\n"),
                                    flags({{"scaled", "false"},
                                           {"integrator", "euler"},
                                           {"initial", "formula"},
                                           {"initial-formula", "sin(3*x)^2"}}));
  EXPECT_EQ(config::flags_text(given),
            "--case guv-3to1 --cells 48 --initial formula --initial-formula 'sin(3*x)^2' "
            "--integrator euler");
  // An option that does nothing is not repeated: it would be refused.
  const config::Configuration idle({}, flags({{"case", "spinodal"},
                                              {"cells", "8"},
                                              {"initial", "caps"},
                                              {"initial-caps", "0 0 1 40"},
                                              {"keep", "first"}}));
  EXPECT_EQ(config::flags_text(idle),
            "--case spinodal --cells 8 --initial caps --initial-caps '0 0 1 40'");
  // Defaults of a scaled model depend on what one unit is.
  const config::Configuration scaled(
      {}, flags({{"case", "guv-3to1"}, {"scaled", "true"}, {"radius", "10"}, {"epsilon", "0.01"}}));
  const std::string text = config::flags_text(scaled);
  EXPECT_NE(text.find("--epsilon 0.01"), std::string::npos) << text;
  EXPECT_NE(text.find("--radius 10"), std::string::npos) << text;
}

TEST(Configuration, ConvertsDefaultsUnderScaled) {
  const config::Configuration physical({}, flags({{"case", "guv-3to1"}}));
  EXPECT_EQ(physical.options().epsilon, 0.05);
  EXPECT_NEAR(physical.units().seconds_per_unit(), 0.025, 1e-15);
  const config::Configuration scaled({}, flags({{"case", "guv-3to1"}, {"scaled", "true"}}));
  EXPECT_NEAR(scaled.options().epsilon, 0.01, 1e-15);
  EXPECT_NEAR(scaled.options().t_end, 1e6, 1e-6);
  const config::Configuration given(
      {}, flags({{"scaled", "true"}, {"epsilon", "0.05"}, {"t-end", "20"}}));
  EXPECT_EQ(given.options().epsilon, 0.05);
  EXPECT_EQ(given.options().t_end, 20);
}

TEST(Configuration, NamesWhatIsWrongAndWhatIsAllowed) {
  const auto of = [](const std::string& name, const std::string& text) {
    return complaint([&] { config::Configuration({}, flags({{name, text}})); });
  };
  EXPECT_EQ(of("cells", "abc"), "--cells: 'abc' is not a finite number");
  EXPECT_EQ(of("cells", "12.5"), "--cells: '12.5' is not a whole number");
  EXPECT_EQ(of("cells", "2"), "--cells: 2 is out of range (allowed: 4 to 4096)");
  EXPECT_EQ(of("epsilon", "nan"), "--epsilon: 'nan' is not a finite number");
  EXPECT_EQ(of("raft-fraction", "1.5"), "--raft-fraction: 1.5 is out of range (allowed: 0 to 1)");
  EXPECT_NE(of("case", "guv").find("--case: unknown case 'guv'; did you mean"), std::string::npos);
  EXPECT_NE(of("output-times", "1,x").find("--output-times: 'x'"), std::string::npos);
  EXPECT_NE(of("initial-formula", "a\nb").find("control character"), std::string::npos);
  EXPECT_NE(of("initial-formula", "\xff\xfe").find("UTF-8"), std::string::npos);
}

// A double would make 9007199254740992 of it.
TEST(Configuration, RefusesSeedsThatLoseDigits) {
  const auto of = [](const std::string& text) {
    return complaint([&] { config::Configuration({}, flags({{"seed", text}})); });
  };
  for (const char* good : {"0", "+7", "1e3", "9007199254740991", "9007199254740992"})
    EXPECT_EQ(of(good), "") << good;
  for (const char* bad : {"9007199254740993", "9007199254740993.0", "9.007199254740993e15",
                          "18446744073709551617", "1e300"})
    EXPECT_EQ(of(bad),
              std::string("--seed: ") + bad + " is out of range (allowed: 0 to 9007199254740992)");
  const auto in_file = [](const std::string& text) {
    return complaint([&] { config::Configuration(read_text("seed = " + text + "\n"), {}); });
  };
  EXPECT_EQ(in_file("9007199254740992"), "");
  EXPECT_NE(in_file("9007199254740993").find("run.toml:1: seed: 9007199254740993 is out of range"),
            std::string::npos);
  EXPECT_NE(in_file("9007199254740993.0").find("in digits alone"), std::string::npos);
  EXPECT_NE(in_file("99999999999999999999").find("run.toml:1"), std::string::npos);
}

TEST(Configuration, SaysHowNumbersAreSeparated) {
  for (const char* text : {"100 20 9", "1;2"})
    EXPECT_EQ(
        complaint([&] {
          config::Configuration({}, flags({{"output-times", text}}));
        }),
        std::string("--output-times: '") + text + "' is not a number; separate numbers by commas");
}

TEST(ConfigFile, NamesFileLineAndKey) {
  const auto of = [](const std::string& text) { return complaint([&] { read_text(text); }); };
  EXPECT_NE(of("cells = 48\nepsilom = 0.1\n")
                .find("run.toml:2: unknown key 'epsilom'; did you mean 'epsilon'?"),
            std::string::npos);
  EXPECT_NE(of("cells = \"48\"\n").find("run.toml:1: cells: a number is needed here"),
            std::string::npos);
  EXPECT_NE(of("cells = 48\ncells = 32\n").find("run.toml:2"), std::string::npos);
  EXPECT_NE(of("surface = sphere\n").find("run.toml:1"), std::string::npos);
  EXPECT_NE(of("output-times = 3\n").find("a list of numbers"), std::string::npos);
  EXPECT_NE(of("scaled = 1\n").find("true or false"), std::string::npos);
  EXPECT_NE(of("[section]\ncells = 3\n").find("unknown key 'section'"), std::string::npos);
  EXPECT_NE(of(std::string("cells = 3\0\n", 11)).find("not a text file"), std::string::npos);
  EXPECT_NE(of(std::string(3 << 20, ' ')).find("more than the"), std::string::npos);
  EXPECT_NE(
      complaint([] { config::read_config_file("/nonexistent/run.toml"); }).find("cannot open"),
      std::string::npos);
  const config::GivenValues nan = read_text("epsilon = nan\n");
  EXPECT_NE(complaint([&] { config::Configuration(nan, {}); }).find("not a finite number"),
            std::string::npos);
}

TEST(ConfigFile, TheResolvedConfigurationReadsBackAsTheSameRun) {
  for (const config::CaseEntry& entry : config::cases()) {
    const config::Configuration first({}, flags({{"case", entry.name},
                                                 {"output-times", "0.5, 1,2"},
                                                 {"initial-formula", "0.5*\"x\\y\""},
                                                 {"epsilon", ".3"}}));
    const config::Configuration second(read_text(config::config_text(first)), {});
    EXPECT_EQ(config::numerical_identity(first), config::numerical_identity(second));
    EXPECT_EQ(config::config_text(first), config::config_text(second));
  }
}

TEST(ConfigFile, ACasesNoiseOnASmallerMeshReadsBack) {
  const config::Configuration configuration({}, flags({{"case", "spinodal"}, {"cells", "24"}}));
  EXPECT_EQ(configuration.options().noise_cells, 24);
  EXPECT_NE(config::config_text(configuration).find("noise-cells = 24"), std::string::npos);
}

TEST(ConfigFile, SurvivesRandomDamage) {
  const std::string good = config::config_text(config::Configuration({}, {}));
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(uniform_random(seed, 3 * k, 0) * text.size());
      text[at] = static_cast<char>(256 * uniform_random(seed, 3 * k, 1));
    }
    if (uniform_random(seed, 99, 0) < 0.3)
      text.resize(static_cast<std::size_t>(uniform_random(seed, 99, 1) * text.size()));
    const std::string answer = complaint([&] { config::Configuration(read_text(text), {}); });
    refused += !answer.empty();
    EXPECT_EQ(answer.find('\n'), std::string::npos);
  }
  EXPECT_GT(refused, 500);
}

// A factor moves no surface, even one whose square is no number: by rounding of differences alone.
TEST(RunSetup, TakesALevelSetOfAnySize) {
  const auto area = [](const std::string& formula) {
    return run::build_run(config::Configuration({}, flags({{"cells", "16"},
                                                           {"epsilon", "0.8"},
                                                           {"surface", "formula"},
                                                           {"surface-formula", formula}})))
        .space->area;
  };
  const double usual = area("x^2+y^2+z^2-1");
  EXPECT_NEAR(area("1e300*(x^2+y^2+z^2-1)"), usual, 1e-9);
  EXPECT_NEAR(area("1e-200*(x^2+y^2+z^2-1)"), usual, 1e-9);
}

TEST(RunSetup, ChecksEverythingBeforeAnythingRuns) {
  const auto of = [](std::initializer_list<std::pair<std::string, std::string>> values) {
    config::GivenValues given = flags(values);
    given.emplace("cells", config::GivenValue{"16", "--cells"});
    return complaint([&] { run::build_run(config::Configuration({}, given)); });
  };
  EXPECT_EQ(of({{"epsilon", "0.5"}}), "");
  EXPECT_EQ(of({{"surface", "spere"}}).find("--surface: unknown surface 'spere'; did you mean"),
            0u);
  EXPECT_EQ(of({{"surface", "torus:major=9"}}).find("--surface: surface 'torus': major=9"), 0u);
  EXPECT_EQ(of({{"surface", "formula"}}).find("--surface: formula needs"), 0u);
  EXPECT_EQ(of({{"surface-formula", "x"}}).find("--surface-formula: it needs"), 0u);
  EXPECT_EQ(of({{"surface", "formula"}, {"surface-formula", "x^2+"}}).find("--surface-formula"),
            0u);
  EXPECT_EQ(of({{"surface", "formula"}, {"surface-formula", "x"}}).find("--surface: surface"), 0u);
  EXPECT_EQ(of({{"mobility", "degenrate"}}).find("--mobility: unknown mobility"), 0u);
  EXPECT_EQ(of({{"well", "a=1,b=0"}}).find("--well: "), 0u);
  EXPECT_EQ(of({{"well", "a=-1,b=1"}}).find("--well: the degenerate"), 0u);
  EXPECT_EQ(of({{"initial", "noize"}}).find("--initial: unknown initial field"), 0u);
  EXPECT_EQ(of({{"initial", "caps"}}).find("--initial-caps: "), 0u);
  EXPECT_EQ(of({{"initial", "caps"}, {"initial-caps", "0 0 1"}}).find("--initial"), 0u);
  EXPECT_EQ(of({{"initial", "restart:/nonexistent"}}).find("--initial: restart: "), 0u);
  EXPECT_EQ(of({{"noise-cells", "99"}}).find("--noise-cells: "), 0u);
  EXPECT_EQ(of({{"initial-caps", "0 0 1 20"}}).find("--initial-caps: it needs --initial caps"), 0u);
  EXPECT_EQ(of({{"initial", "caps"}, {"initial-caps", "0 0 1 20"}, {"raft-fraction", "0.2"}})
                .find("--raft-fraction: it needs --initial noise or band-limited"),
            0u);
  EXPECT_EQ(of({{"initial", "band-limited"}, {"noise-cells", "8"}})
                .find("--noise-cells: it needs --initial noise"),
            0u);
  EXPECT_NE(of({{"surface", "formla"}}).find("did you mean 'formula'"), std::string::npos);
  EXPECT_EQ(of({{"integrator", "eular"}}).find("--integrator: unknown integrator"), 0u);
  EXPECT_EQ(of({{"linear-solver", "blok"}}).find("--linear-solver: unknown linear solver"), 0u);
  EXPECT_EQ(of({{"keep", "third"}}).find("--keep: unknown solution"), 0u);
  EXPECT_EQ(of({{"potential", "x"}}).find("--potential: "), 0u);
  EXPECT_EQ(of({{"output-times", "1,1e9"}}).find("--output-times: "), 0u);
  EXPECT_EQ(of({{"min-step", "2"}, {"max-step", "1"}}).find("--min-step: "), 0u);
}

// Steps are divided by, and the quotients squared.
TEST(RunSetup, RefusesTimesThatDoublesCannotHold) {
  const auto of = [](std::initializer_list<std::pair<std::string, std::string>> values) {
    config::GivenValues given = flags(values);
    given.emplace("cells", config::GivenValue{"8", "--cells"});
    return complaint(
        [&] { run::build_run(config::Configuration({}, given), run::InitialState{true}); });
  };
  const std::string allowed = " is too short or too long to compute with (allowed: ";
  EXPECT_EQ(of({{"t-end", "1e-300"}}), "--t-end: 1e-300" + allowed + "1e-102 to 1e+98)");
  EXPECT_EQ(of({{"t-end", "1e200"}}), "--t-end: 1e+200" + allowed + "1e-102 to 1e+98)");
  for (const char* option : {"initial-step", "min-step", "max-step", "ida-initstep", "ida-maxstep"})
    EXPECT_EQ(of({{option, "1e-200"}}).find(std::string("--") + option + ": 1e-200" + allowed), 0u);
  EXPECT_EQ(of({{"output-times", "1,1e-200"}}).find("--output-times: 1e-200" + allowed), 0u);
  // A step that is added to the time of the run has to change it.
  EXPECT_EQ(of({{"max-step", "1e-20"}, {"t-end", "1"}}),
            "--max-step: 1e-20" + allowed + "0, or 1e-14 to 1e+98)");
  EXPECT_EQ(of({{"t-end", "1e-100"}}), "");
  EXPECT_EQ(of({{"t-end", "1e-12"}, {"output-times", "0,1e-13"}}), "");
  // In units of the model it would be infinite.
  EXPECT_NE(of({{"diffusion", "1e30"}, {"t-end", "1e300"}}).find("--t-end: 1e+300"),
            std::string::npos);
}

TEST(RunSetup, SortsOutputTimesAndNamesThoseThatAreRepeated) {
  const auto of = [](const std::string& times) {
    return run::build_run(
        config::Configuration({},
                              flags({{"cells", "8"}, {"t-end", "100"}, {"output-times", times}})),
        run::InitialState{true});
  };
  const run::RunSetup run = of("100,20,9,1e1,10, 20.0,10");
  EXPECT_EQ(run.output_labels, (std::vector<double>{9, 10, 20, 100}));
  EXPECT_EQ(run.output_times.size(), 4u);
  EXPECT_EQ(run.repeated_labels, (std::vector<double>{10, 20}));
  EXPECT_TRUE(of("1,2").repeated_labels.empty());
}

TEST(RunSetup, RefusesOptionsOfMethodsThatAreNotChosen) {
  config::GivenValues given = flags({{"cells", "8"}, {"ida-maxord", "2"}});
  const auto of = [&](const auto&... compared) {
    return complaint([&] {
      run::build_run(config::Configuration({}, given), run::InitialState{true}, compared...);
    });
  };
  EXPECT_EQ(of(), "");
  given["keep"] = {"first", "--keep"};
  EXPECT_EQ(of().find("--keep: it needs --integrator euler"), 0u);
  given["integrator"] = {"euler", "--integrator"};
  EXPECT_EQ(of().find("--ida-maxord: it needs --integrator ida"), 0u);
  EXPECT_EQ(of(config::Compared{{"integrator", {"euler", "ida"}}}), "");
  given["ida-maxord"].where = "run.toml:4: ida-maxord";
  EXPECT_EQ(of(), "");
  given["teko-inverse"] = {"ifpack2", "--teko-inverse"};
  EXPECT_EQ(of().find("--teko-inverse: it needs --linear-solver teko"), 0u);
  EXPECT_EQ(of(config::Compared{{"linear-solver", {"teko", "block"}}}), "");
}

}  // namespace
}  // namespace traceraft
