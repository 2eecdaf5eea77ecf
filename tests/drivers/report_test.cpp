// Pages, pictures and animations; the page in a browser, if there is one.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace traceraft {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::content;
using testing::names;
using testing::ProgramEnd;
using testing::shell;
using testing::TemporaryFolder;
using testing::traceraft;

class ReportTest : public ::testing::Test {
 protected:
  TemporaryFolder folder;
  std::string out(const std::string& name) const { return (folder.path / name).string(); }
  void run(const std::string& name) const {
    const ProgramEnd made =
        traceraft("run --case two-rafts --cells 20 --epsilon 0.6 --quiet --out " + out(name));
    ASSERT_EQ(made.code, 0) << made.output;
  }
  // The smaller raft vanishes, and its small cells with it.
  void runs_adaptively(const std::string& name) const {
    const ProgramEnd made = traceraft(
        "run --case two-rafts --cells 64 --epsilon 0.2 --mesh adaptive --t-end 4 --quiet --out " +
        out(name));
    ASSERT_EQ(made.code, 0) << made.output;
  }
};

TEST_F(ReportTest, MakesAPagePicturesAndAnAnimation) {
  run("a");
  const ProgramEnd made =
      traceraft("report " + out("a") + " --frames 5 --snapshots " + out("pictures") +
                " --animation " + out("a.gif") + " --pixels 64");
  ASSERT_EQ(made.code, 0) << made.output;
  const std::string page = content(folder.path / "a/report.html");
  for (const char* part : {"id=\"viewer\"", "energy-guard", "mass_drift"})
    EXPECT_TRUE(names(page, part));
  EXPECT_EQ(page.find("http-equiv"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos) << "a page needs nothing else";
  for (int k = 0; k < 5; ++k)
    EXPECT_EQ(
        content(folder.path / "pictures" / ("frame-000" + std::to_string(k) + ".png")).substr(1, 3),
        "PNG");
  EXPECT_FALSE(fs::exists(folder.path / "pictures/frame-0005.png"));
  // Pictures with the time in them, and without.
  ASSERT_EQ(traceraft("report --quiet " + out("a") + " --frames 5 --pixels 64 --bare --snapshots " +
                      out("bare"))
                .code,
            0);
  EXPECT_NE(content(folder.path / "bare/frame-0004.png"),
            content(folder.path / "pictures/frame-0004.png"));
  EXPECT_EQ(content(folder.path / "a.gif").substr(0, 6), "GIF89a");
}

// A frame has the mesh of its time.
TEST_F(ReportTest, ShowsFieldsOnMeshesThatChange) {
  runs_adaptively("a");
  ASSERT_EQ(traceraft("report --quiet " + out("a") + " --frames 4 --pixels 64 --snapshots " +
                      out("pictures"))
                .code,
            0);
  const std::string page = content(folder.path / "a/report.html");
  const std::string begin = "window.traceraftScene = ";
  const std::size_t at = page.find(begin) + begin.size();
  const json scene = json::parse(page.substr(at, page.find(";</script>", at) - at));
  ASSERT_GT(scene["meshes"].size(), 1);
  EXPECT_NE(scene["meshes"][0], scene["meshes"][1]);
  EXPECT_EQ(scene["meshOf"].size(), scene["labels"].size());
  EXPECT_EQ(scene["meshOf"].back(), scene["meshes"].size() - 1);
  EXPECT_TRUE(fs::exists(folder.path / "pictures/frame-0003.png"));
}

TEST_F(ReportTest, ShowsMeasurementsBesideWhatIsInSeconds) {
  const std::string data = " --data " TRACERAFT_ROOT "/verification/data/synthetic/guv-2to1";
  run("a");
  ASSERT_EQ(traceraft("report --quiet " + out("a") + data).code, 0);
  const std::string page = content(folder.path / "a/report.html");
  EXPECT_TRUE(names(page, "56 measurements"));
  // 43.31925 um around 4.015831 um are 53.9356 um around the 5 um of the run.
  EXPECT_TRUE(names(content(folder.path / "a/report-charts/perimeter.gp"), " 53.9356"));
  const std::string kept = TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1";
  ASSERT_EQ(traceraft("report --quiet " + kept + " --out " + out("kept.html") + data).code, 0);
  EXPECT_TRUE(names(content(folder.path / "kept.html"), "synthetic"));
  ASSERT_EQ(
      traceraft("run --case two-rafts --cells 20 --epsilon 0.12 --scaled --t-end 0.001 --quiet "
                "--out " +
                out("s"))
          .code,
      0);
  const ProgramEnd refused = traceraft("report " + out("s") + data);
  EXPECT_TRUE(testing::refuses(refused, "--data: "));
}

TEST_F(ReportTest, ShowsEnsemblesAndCopiesFinishedPages) {
  ASSERT_EQ(
      traceraft(
          "ensemble --case guv-2to1 --cells 20 --epsilon 0.5 --t-end 20 --runs 2 --quiet --out " +
          out("e"))
          .code,
      0);
  ASSERT_EQ(traceraft("report --quiet " + out("e")).code, 0);
  const std::string page = content(folder.path / "e/report.html");
  for (const char* fact : {"seed-1", "id=\"viewer\"", "<svg"}) EXPECT_TRUE(names(page, fact));
  // A report of a kept ensemble shows all but the surface.
  const std::string kept = TRACERAFT_ROOT "/verification/data/ensembles/guv-2to1";
  ASSERT_EQ(traceraft("report --quiet " + kept + " --out " + out("kept.html")).code, 0);
  const std::string of_kept = content(folder.path / "kept.html");
  for (const char* fact : {"10 runs", "<svg"}) EXPECT_TRUE(names(of_kept, fact));
  EXPECT_FALSE(names(of_kept, "id=\"viewer\""));
  ASSERT_EQ(traceraft("verify geometry energy --quick --quiet --jobs 2 --out " + out("v")).code, 0);
  ASSERT_EQ(traceraft("report --quiet " + out("v")).code, 0);
  EXPECT_EQ(content(folder.path / "v/report.html"), content(folder.path / "v/verify.html"));
  // The processes side by side have left their results only.
  EXPECT_TRUE(fs::exists(folder.path / "v/geometry.json"));
  EXPECT_TRUE(fs::exists(folder.path / "v/energy.json"));
  EXPECT_FALSE(fs::exists(folder.path / "v/job-energy"));
  const auto measured = fs::last_write_time(folder.path / "v/energy.json");
  const ProgramEnd again = traceraft("verify geometry energy --quick --jobs 2 --out " + out("v"));
  EXPECT_EQ(again.code, 0) << again.output;
  EXPECT_EQ(fs::last_write_time(folder.path / "v/energy.json"), measured);
}

TEST_F(ReportTest, SaysWhatItCannotShow) {
  EXPECT_EQ(traceraft("report " + out("nowhere")).code, 2);
  EXPECT_FALSE(fs::exists(folder.path / "nowhere")) << "a question leaves nothing behind";
  ASSERT_EQ(
      traceraft(
          "run --case two-rafts --cells 16 --epsilon 0.8 --t-end 0.1 --no-fields --quiet --out " +
          out("a"))
          .code,
      0);
  const ProgramEnd made = traceraft("report " + out("a"));
  EXPECT_EQ(made.code, 0) << made.output;
  EXPECT_FALSE(names(content(folder.path / "a/report.html"), "id=\"viewer\""));
  EXPECT_EQ(traceraft("report --quiet " + out("a") + " --animation " + out("a.gif")).code, 2);
  const std::string config = content(folder.path / "a/config.toml");
  EXPECT_EQ(traceraft("report " + out("a") + " --animation " + out("a/config.toml")).code, 2);
  EXPECT_EQ(traceraft("report " + out("a") + " --out " + out("a/config.toml")).code, 2);
  EXPECT_EQ(content(folder.path / "a/config.toml"), config);
  run("b");
  std::ofstream(folder.path / "b/fields/field-0003.vtu") << "damaged";
  const ProgramEnd damaged = traceraft("report " + out("b"));
  EXPECT_EQ(damaged.code, 4);
  EXPECT_TRUE(names(damaged.output, "field-0003.vtu"));
  fs::remove(folder.path / "b/fields/field-0003.vtu");
  EXPECT_EQ(traceraft("report --quiet " + out("b")).code, 0);
}

TEST_F(ReportTest, NoticesWhatHasChangedSinceTheRun) {
  run("a");
  for (const char* name : {"series.csv", "observables.csv", "rafts.csv", "fields.pvd"}) {
    const fs::path file = folder.path / "a" / name;
    const std::string whole = content(file);
    std::string changed = whole;
    const std::size_t digit = changed.find_first_of("0123456789", changed.size() / 2);
    ASSERT_NE(digit, std::string::npos) << name;
    changed[digit] = changed[digit] == '7' ? '8' : '7';
    std::ofstream(file) << changed;
    const ProgramEnd end = traceraft("report --quiet " + out("a"));
    EXPECT_EQ(end.code, 4) << name;
    EXPECT_TRUE(names(end.output, name)) << end.output;
    std::ofstream(file) << whole;
  }
  const std::string series = content(folder.path / "a/series.csv");
  std::ofstream(folder.path / "a/series.csv")
      << series << series.substr(series.rfind('\n', series.size() - 2) + 1);
  EXPECT_EQ(traceraft("report --quiet " + out("a")).code, 4) << "a row too many";
  std::ofstream(folder.path / "a/series.csv") << series;
  const std::string config = content(folder.path / "a/config.toml");
  std::string other = config;
  other.replace(other.find("radius = 5"), 10, "radius = 6");
  std::ofstream(folder.path / "a/config.toml") << other;
  EXPECT_EQ(traceraft("report --quiet " + out("a")).code, 4) << "another vesicle";
  std::ofstream(folder.path / "a/config.toml") << config;
  EXPECT_EQ(traceraft("report --quiet " + out("a")).code, 0);
}

TEST_F(ReportTest, WritesOverNoFileOfOthers) {
  run("a");
  const fs::path other = folder.path / "other", pictures = folder.path / "pictures";
  fs::create_directories(other);
  fs::create_directories(pictures);
  fs::create_directories(folder.path / "a/report-charts");
  std::ofstream(other / "dt.svg") << "precious";
  fs::create_symlink(other / "dt.svg", folder.path / "a/report-charts/dt.svg");
  ASSERT_EQ(traceraft("report --quiet " + out("a")).code, 0);
  EXPECT_EQ(content(other / "dt.svg"), "precious") << "through a link";
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder.path / "a/report-charts/dt.svg")));
  fs::remove_all(folder.path / "a/report-charts");
  fs::create_symlink(other, folder.path / "a/report-charts");
  EXPECT_EQ(traceraft("report --quiet " + out("a")).code, 4) << "through a linked folder";
  EXPECT_EQ(content(other / "dt.svg"), "precious");
  EXPECT_FALSE(fs::exists(other / "dt.gp"));
  fs::remove(folder.path / "a/report-charts");
  std::ofstream(pictures / "frames.csv") << "precious";
  const std::string draw = "report --quiet --frames 2 --pixels 64 --snapshots " + out("pictures");
  EXPECT_EQ(traceraft(draw + " " + out("a")).code, 2);
  EXPECT_EQ(content(pictures / "frames.csv"), "precious");
  fs::remove(pictures / "frames.csv");
  for (int time = 0; time < 2; ++time)
    EXPECT_EQ(traceraft(draw + " " + out("a")).code, 0) << "its own may be drawn again";
}

// A browser that a program steers, by the WebDriver protocol.
class Browser {
 public:
  Browser() {
    driver_ = fork();
    if (driver_ == 0) {
      execlp("sh", "sh", "-c", ("exec chromedriver --port=" + port_ + " >/dev/null 2>&1").c_str(),
             static_cast<char*>(nullptr));
      _exit(127);
    }
    const json options = {{"args",
                           {"--headless", "--no-sandbox", "--use-angle=swiftshader",
                            "--enable-unsafe-swiftshader", "--window-size=900,900"}}};
    const json wanted = {{"capabilities",
                          {{"alwaysMatch",
                            {{"browserName", "chrome"},
                             {"goog:chromeOptions", options},
                             {"goog:loggingPrefs", {{"browser", "ALL"}}}}}}}};
    for (int i = 0; i < 100 && session_.empty(); ++i) {
      usleep(200000);
      const json answer = send("/session", wanted);
      if (answer.contains("value") && answer["value"].contains("sessionId"))
        session_ = "/session/" + answer["value"]["sessionId"].get<std::string>();
    }
  }
  ~Browser() {
    if (ready()) (void)shell("curl -s -X DELETE http://127.0.0.1:" + port_ + session_);
    kill(driver_, SIGTERM);
    waitpid(driver_, nullptr, 0);
  }
  bool ready() const { return !session_.empty(); }
  void open(const fs::path& page) {
    (void)send(session_ + "/url", {{"url", "file://" + page.string()}});
  }
  json evaluate(const std::string& script) {
    return send(session_ + "/execute/sync",
                {{"script", "return " + script}, {"args", json::array()}})["value"];
  }
  json complaints() { return send(session_ + "/se/log", {{"type", "browser"}})["value"]; }

 private:
  json send(const std::string& path, const json& body) const {
    const fs::path file = scratch_.path / "body.json";
    std::ofstream(file) << body.dump();
    const ProgramEnd answer =
        shell("curl -s --max-time 60 -H 'Content-Type: application/json' -d @" + file.string() +
              " http://127.0.0.1:" + port_ + path);
    return json::parse(answer.output, nullptr, false);
  }
  TemporaryFolder scratch_;
  std::string port_ = std::to_string(20000 + getpid() % 20000), session_;
  pid_t driver_ = -1;
};

TEST_F(ReportTest, WorksInABrowser) {
  if (shell("command -v chromedriver && command -v chromium && command -v curl").code != 0)
    GTEST_SKIP() << "needs the Debian packages chromium, chromium-driver and curl";
  run("a");
  ASSERT_EQ(traceraft("report --quiet " + out("a")).code, 0);
  Browser browser;
  ASSERT_TRUE(browser.ready());
  browser.open(folder.path / "a/report.html");
  for (int i = 0; i < 100 && browser.evaluate("document.body.dataset.ready || ''") == ""; ++i)
    usleep(100000);
  ASSERT_EQ(browser.evaluate("document.body.dataset.ready"), "yes")
      << browser.evaluate("document.getElementById('time-label').textContent");
  const std::string last = browser.evaluate("document.body.dataset.frame");
  const std::string picture = browser.evaluate("document.querySelector('canvas').toDataURL()");
  const std::string label = browser.evaluate("document.getElementById('time-label').textContent");
  EXPECT_NE(last, "0");
  (void)browser.evaluate(
      "(() => { const s = document.getElementById('time'); s.value = 0; s.dispatchEvent(new "
      "Event('input')); })()");
  EXPECT_EQ(browser.evaluate("document.body.dataset.frame"), "0");
  EXPECT_NE(browser.evaluate("document.getElementById('time-label').textContent"), label);
  // Two rafts instead of one.
  EXPECT_NE(browser.evaluate("document.querySelector('canvas').toDataURL()"), picture);
  const auto expect_no_complaint = [&browser] {
    for (const json& entry : browser.complaints())
      EXPECT_NE(entry["level"], "SEVERE") << entry["message"];
  };
  expect_no_complaint();
  RecordProperty("milliseconds_to_open",
                 static_cast<int>(browser.evaluate("performance.now()").get<double>()));
  // Meshes that change do so in the view.
  runs_adaptively("changing");
  ASSERT_EQ(traceraft("report --quiet " + out("changing")).code, 0);
  browser.open(folder.path / "changing/report.html");
  for (int i = 0; i < 100 && browser.evaluate("document.body.dataset.ready || ''") == ""; ++i)
    usleep(100000);
  ASSERT_EQ(browser.evaluate("document.body.dataset.ready"), "yes");
  const std::string one_raft = browser.evaluate("document.querySelector('canvas').toDataURL()");
  (void)browser.evaluate(
      "(() => { const s = document.getElementById('time'); s.value = 0; s.dispatchEvent(new "
      "Event('input')); })()");
  EXPECT_NE(browser.evaluate("document.querySelector('canvas').toDataURL()"), one_raft);
  expect_no_complaint();
  // Pages without a surface have their charts.
  const std::string data = TRACERAFT_ROOT "/verification/data/";
  const std::string kept = data + "ensembles/guv-2to1", measured = data + "synthetic/guv-2to1";
  ASSERT_EQ(traceraft("report --quiet " + kept + " --out " + out("kept.html")).code, 0);
  ASSERT_EQ(
      traceraft("data compare " + measured + " --ensemble " + kept + " --out " + out("c")).code, 0);
  for (const char* page : {"kept.html", "c/comparison.html"}) {
    browser.open(folder.path / page);
    EXPECT_GE(browser
                  .evaluate("Array.from(document.querySelectorAll('svg, img')).filter(e => "
                            "e.getBoundingClientRect().width > 300).length")
                  .get<int>(),
              3)
        << page;
    expect_no_complaint();
  }
}

}  // namespace
}  // namespace traceraft
