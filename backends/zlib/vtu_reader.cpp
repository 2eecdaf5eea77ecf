#include "backends/zlib/vtu_reader.hpp"

#include <cstdint>
#include <cstring>

#include "backends/zlib/vtk_array.hpp"
#include "kernel/core/error.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::zlib {
namespace {

// The text between two others from `begin` on, which moves behind them. Throws IoError.
std::string between(const std::string& text, const std::string& before, const std::string& after,
                    std::size_t& begin) {
  const std::size_t at = text.find(before, begin);
  const std::size_t first = at + before.size();
  const std::size_t last = at == std::string::npos ? at : text.find(after, first);
  if (last == std::string::npos) throw IoError("this is not a file of fields from traceraft");
  begin = last + after.size();
  return text.substr(first, last - first);
}

template <class T>
std::vector<T> array(const std::string& text, const std::string& name) {
  std::size_t begin = 0;
  (void)between(text, " Name=\"" + name + "\"", ">\n", begin);
  const std::size_t end = text.find('\n', begin);
  if (end == std::string::npos) throw IoError("an array does not end");
  const std::string data = decoded_array(text.substr(begin, end - begin));
  std::vector<T> values(data.size() / sizeof(T));
  std::memcpy(values.data(), data.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace

SurfaceField read_vtu(const std::string& text, const std::string& field) {
  const std::vector<float> positions = array<float>(text, "Points");
  const std::vector<float> values = array<float>(text, field);
  const std::vector<std::int32_t> corners = array<std::int32_t>(text, "connectivity");
  const std::size_t points = values.size();
  if (positions.size() != 3 * points || corners.size() % 3 != 0)
    throw IoError("the arrays of a file of fields do not match");
  SurfaceField result;
  for (std::size_t p = 0; p < points; ++p)
    result.mesh.position.emplace_back(positions[3 * p], positions[3 * p + 1], positions[3 * p + 2]);
  for (std::size_t t = 0; t < corners.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k)
      if (corners[t + k] < 0 || static_cast<std::size_t>(corners[t + k]) >= points)
        throw IoError("a triangle has a corner that is not there");
    result.mesh.triangles.push_back({corners[t], corners[t + 1], corners[t + 2]});
  }
  result.values =
      Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(points))
          .cast<double>();
  return result;
}

std::vector<int> read_cells(const std::string& text, const std::string& field) {
  const std::vector<std::int32_t> values = array<std::int32_t>(text, field);
  return {values.begin(), values.end()};
}

std::vector<std::string> pieces_of_pvtu(const std::string& text) {
  std::vector<std::string> pieces;
  for (std::size_t begin = 0; text.find("<Piece Source=\"", begin) != std::string::npos;)
    pieces.push_back(between(text, "<Piece Source=\"", "\"", begin));
  return pieces;
}

std::vector<std::pair<double, std::string>> files_of_pvd(const std::string& text) {
  std::vector<std::pair<double, std::string>> files;
  for (std::size_t begin = 0; text.find("<DataSet timestep=\"", begin) != std::string::npos;) {
    const std::string time = between(text, "<DataSet timestep=\"", "\"", begin);
    files.emplace_back(parse_number("time of a field", time),
                       between(text, "file=\"", "\"", begin));
  }
  return files;
}

}  // namespace traceraft::zlib
