#include <CLI/CLI.hpp>
#include <cstdint>

#include "backends/gif/gif_writer.hpp"
#include "backends/gif/label.hpp"
#include "backends/png/png_file.hpp"
#include "backends/posix/durable_file.hpp"
#include "drivers/commands.hpp"
#include "drivers/config/number_checks.hpp"
#include "drivers/exit_codes.hpp"
#include "drivers/input/dataset.hpp"
#include "drivers/report/report_page.hpp"
#include "drivers/text/say.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"
#include "kernel/core/text.hpp"

namespace traceraft::report {
namespace {

namespace fs = std::filesystem;

struct ReportRequest {
  std::string folder, data, out, snapshots, animation;
  int frames = 60, pixels = 480;
  double detail = 0.015;
  int pause = 20;
  bool bare = false, quiet = false;
};

constexpr char kFrames[] = "frames.csv", kFramesHeader[] = "picture,t\n";

std::string frame_name(std::size_t number) {
  return formatted("frame-%04zu.png", number);
}

void write_pictures(const ReportRequest& request) {
  if (request.snapshots.empty() && request.animation.empty()) return;
  const fs::path run = run_to_show(request.folder);
  const auto [low, high] = phases_of(run);
  const SurfaceFrames frames = read_frames(run, request.detail, request.frames);
  const std::vector<std::string> labels = time_labels(run, frames.times);
  std::vector<observables::Image> images;
  for (std::size_t k = 0; k < frames.frames.size(); ++k) {
    const auto& [mesh, values] = frames.frames[k];
    images.push_back(
        observables::draw_front_and_back(frames.meshes[mesh], values, low, high, request.pixels));
    if (!request.bare) gif::write_label(images.back(), labels[k]);
  }
  if (!request.animation.empty()) {
    posix::write_durably(request.animation, gif::gif_bytes(images, request.pause));
    if (!request.quiet) text::say("%s\n", request.animation);
  }
  if (request.snapshots.empty()) return;
  fs::create_directories(request.snapshots);
  std::string times = kFramesHeader;
  for (std::size_t k = 0; k < images.size(); ++k) {
    posix::write_durably(fs::path(request.snapshots) / frame_name(k), png::png_bytes(images[k]));
    times += frame_name(k) + "," + format_number(frames.times[k]) + "\n";
  }
  posix::write_durably(fs::path(request.snapshots) / kFrames, times);
  if (request.quiet) return;
  text::say("%zu pictures in %s\n", images.size(), request.snapshots);
  if (fs::exists(fs::path(request.snapshots) / frame_name(images.size())))
    text::say("pictures with larger numbers in this folder are from an earlier command\n");
}

// Pictures of an earlier command are replaced, and no others.
void refuse_other_pictures(const fs::path& folder) {
  constexpr std::uint64_t kLargest = 1 << 24;
  const fs::path list = folder / kFrames;
  const bool own =
      fs::exists(list) && posix::read_file(list, kLargest).rfind(kFramesHeader, 0) == 0;
  for (const fs::path& other : {list, folder / frame_name(0)})
    if (!own && fs::exists(other))
      throw InputError("--snapshots: " + folder.string() + " holds another " +
                       other.filename().string() + "; choose another folder");
}

// A slip of the pen must not write over a configuration or a table.
void refuse_other_files(const ReportRequest& request) {
  const auto ends_on = [](const fs::path& path, const char* extension) {
    return path.extension() == extension;
  };
  if (!request.animation.empty() && !ends_on(request.animation, ".gif"))
    throw InputError("--animation: " + request.animation + " must end in .gif");
  if (!request.out.empty() && (!ends_on(request.out, ".html") || fs::is_directory(request.out)))
    throw InputError("--out: " + request.out + " must be a file whose name ends in .html");
}

int report(const ReportRequest& request) {
  refuse_other_files(request);
  if (!request.snapshots.empty()) refuse_other_pictures(request.snapshots);
  const fs::path out =
      request.out.empty() ? fs::path(request.folder) / "report.html" : fs::path(request.out);
  const std::string missing = write_report_page(
      request.folder, out,
      {request.frames, request.detail, out.parent_path() / (out.stem().string() + "-charts"),
       request.data.empty() ? std::nullopt : std::optional(input::read_dataset(request.data))});
  write_pictures(request);
  if (!request.quiet) {
    if (!missing.empty()) text::say("missing from the page: %s\n", missing);
    text::say("open next: %s\n", out);
  }
  return drivers::kSuccess;
}

drivers::Action define_report(CLI::App& app) {
  const auto request = std::make_shared<ReportRequest>();
  app.add_option("folder", request->folder,
                 "folder of a run, ensemble, comparison, calibration, verification, ...")
      ->type_name("DIR")
      ->required();
  app.add_option("--data", request->data,
                 "folder of measured series, shown in the charts of a run or an ensemble")
      ->type_name("DIR");
  app.add_option("--out", request->out, "HTML file to write; default: report.html in the folder")
      ->type_name("FILE");
  app.add_option("--frames", request->frames, "largest number of output times that are shown")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--detail", request->detail,
                 "size of the smallest detail of the surface that is shown, in units of the size "
                 "of the surface")
      ->check(config::between(1e-4, 0.2))
      ->capture_default_str();
  app.add_option("--snapshots", request->snapshots,
                 "folder for pictures (PNG) of all frames, and a table of their times")
      ->type_name("DIR");
  app.add_option("--animation", request->animation, "file for an animation (GIF) of all frames")
      ->type_name("FILE");
  app.add_option("--pixels", request->pixels, "height of pictures and animation, in pixels")
      ->check(CLI::Range(16, 4096))
      ->capture_default_str();
  app.add_option("--pause", request->pause,
                 "time between two frames of the animation, in units of 1/100 s")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  app.add_flag("--bare", request->bare, "leave the time out of pictures and animation");
  app.add_flag("--quiet", request->quiet, "print errors only");
  app.footer("Example: traceraft report runs/guv-2to1-1 --animation rafts.gif");
  return [request] { return report(*request); };
}

}  // namespace

drivers::Command report_command() {
  return {"report", "write a page, pictures or an animation of the results in a folder",
          drivers::Ranks::one, define_report};
}

}  // namespace traceraft::report
