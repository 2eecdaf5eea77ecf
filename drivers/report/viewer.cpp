#include "drivers/report/viewer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "backends/posix/durable_file.hpp"
#include "backends/zlib/vtk_array.hpp"
#include "drivers/report/viewer_script.hpp"
#include "drivers/text/encoders.hpp"
#include "kernel/core/error.hpp"

namespace traceraft::report {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLargestScript = 1 << 24;
constexpr char kLibrary[] = "/usr/share/javascript/three/build/three.min.js";
constexpr char kControls[] = "/usr/share/javascript/three/examples/js/controls/OrbitControls.js";
constexpr char kLicence[] = "/usr/share/doc/libjs-three/copyright";

template <class T>
std::string data_block(const char* id, const std::vector<T>& values) {
  const std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return std::string("<script type=\"text/plain\" id=\"") + id + "\">" +
         zlib::base64(zlib::deflated(bytes)) + "</script>\n";
}

// All meshes, one after the other.
std::string mesh_blocks(const std::vector<observables::SurfaceMesh>& meshes) {
  double size = 0;
  for (const observables::SurfaceMesh& mesh : meshes)
    for (const Point& x : mesh.position) size = std::max(size, x.norm());
  std::vector<std::int16_t> positions;
  std::vector<std::uint32_t> corners;
  for (const observables::SurfaceMesh& mesh : meshes) {
    for (const Point& x : mesh.position)
      for (int k = 0; k < 3; ++k)
        positions.push_back(static_cast<std::int16_t>(std::lround(x[k] / size * 32767)));
    for (const auto& triangle : mesh.triangles)
      for (const int corner : triangle) corners.push_back(static_cast<std::uint32_t>(corner));
  }
  return data_block("mesh-positions", positions) + data_block("mesh-triangles", corners);
}

std::string frame_block(const std::vector<Frame>& frames, const View& view) {
  std::vector<std::uint8_t> bytes;
  for (const Frame& frame : frames)
    for (const double c : frame.values)
      bytes.push_back(static_cast<std::uint8_t>(
          std::lround(255 * std::clamp((c - view.low) / (view.high - view.low), 0.0, 1.0))));
  return data_block("frames", bytes);
}

// The script needs to know what the blocks hold.
std::string scene(const std::vector<observables::SurfaceMesh>& meshes,
                  const std::vector<Frame>& frames, const View& view) {
  nlohmann::json json{{"labels", view.labels},
                      {"differences", view.differences},
                      {"meshes", nlohmann::json::array()},
                      {"meshOf", nlohmann::json::array()}};
  for (const observables::SurfaceMesh& mesh : meshes)
    json["meshes"].push_back(
        {{"points", mesh.position.size()}, {"triangles", mesh.triangles.size()}});
  for (const Frame& frame : frames) json["meshOf"].push_back(frame.mesh);
  return text::in_html_script(json.dump());
}

// The licence goes where the library goes. "--" must not be in a comment.
std::string licence_comment() {
  std::string text = posix::read_file(kLicence, kLargestScript);
  for (std::size_t at = 0; (at = text.find("--", at)) != std::string::npos;)
    text.replace(at, 2, "- ");
  return "<!-- three.js:\n" + text + "-->\n";
}

// A script must not end before its end.
std::string script(std::string text) {
  for (std::size_t at = 0; (at = text.find("</script", at)) != std::string::npos; at += 9)
    text.replace(at, 2, "<\\/");
  return "<script>" + text + "</script>\n";
}

}  // namespace

std::string add_viewer(output::Page& page, const std::vector<observables::SurfaceMesh>& meshes,
                       const std::vector<Frame>& frames, const View& view) {
  for (const char* file : {kLibrary, kControls, kLicence})
    if (!fs::exists(file)) return "three.js is not installed (Debian package libjs-three)";
  const std::string last = std::to_string(frames.size() - 1);
  page.raw(
      "<div id=\"viewer\" style=\"width:100%;max-width:640px\"></div>\n"
      "<p><input type=\"range\" id=\"time\" min=\"0\" step=\"1\" max=\"" +
      last + "\" value=\"" + std::to_string(view.first) +
      "\" style=\"width:60%\" aria-label=\"time\"> "
      "<button id=\"play\">play</button> <span id=\"time-label\"></span><br>"
      "<label><input type=\"checkbox\" id=\"through\" checked> see through to "
      "the far side</label></p>");
  page.raw(mesh_blocks(meshes) + frame_block(frames, view));
  page.raw(licence_comment() + script(posix::read_file(kLibrary, kLargestScript)) +
           script(posix::read_file(kControls, kLargestScript)) +
           script("window.traceraftScene = " + scene(meshes, frames, view) + ";") +
           script(kViewerScript));
  return "";
}

}  // namespace traceraft::report
