#include "backends/zlib/vtu_writer.hpp"

#include <cstdint>

#include "backends/zlib/vtk_array.hpp"
#include "kernel/core/parameters.hpp"

namespace traceraft::zlib {
namespace {

template <class T>
std::string array(const char* type, const std::string& name, int components,
                  const std::vector<T>& values) {
  return "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name +
         "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"binary\">\n" +
         encoded_array(values.data(), values.size() * sizeof(T)) + "\n</DataArray>\n";
}

std::string file_head(const char* type) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + std::string(type) +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
         "compressor=\"vtkZLibDataCompressor\">\n";
}

}  // namespace

std::string vtu_text(const fem::SurfaceSpace& space, double length,
                     const std::vector<PointField>& fields,
                     const std::vector<CellField>& cell_fields) {
  const mesh::CutSurface& surface = space.surface;
  std::vector<char> needed(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    if (space.owns_triangle(t))
      for (const int p : surface.triangles[t]) needed[p] = 1;
  std::vector<int> used;  // points, and their numbers in the file
  std::vector<std::int32_t> number(surface.points.size(), -1), connectivity, offsets;
  std::vector<float> coordinates;
  for (std::size_t p = 0; p < needed.size(); ++p) {
    if (!needed[p]) continue;
    number[p] = static_cast<std::int32_t>(used.size());
    used.push_back(static_cast<int>(p));
    const Point x = length * surface.position[p];
    for (int axis = 0; axis < 3; ++axis) coordinates.push_back(static_cast<float>(x[axis]));
  }
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    if (!space.owns_triangle(t)) continue;
    for (const int p : surface.triangles[t]) connectivity.push_back(number[p]);
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(offsets.size(), 5);  // VTK_TRIANGLE

  std::string text = file_head("UnstructuredGrid") +
                     "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(used.size()) +
                     "\" NumberOfCells=\"" + std::to_string(offsets.size()) + "\">\n<PointData>\n";
  for (const PointField& field : fields) {
    std::vector<float> values;
    for (const int p : used) values.push_back(static_cast<float>(field.values[p]));
    text += array("Float32", field.name, 1, values);
  }
  text += "</PointData>\n<CellData>\n";
  for (const CellField& field : cell_fields) {
    std::vector<std::int32_t> values;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (space.owns_triangle(t)) values.push_back(field.values[t]);
    text += array("Int32", field.name, 1, values);
  }
  text += "</CellData>\n<Points>\n" + array("Float32", "Points", 3, coordinates) +
          "</Points>\n<Cells>\n" + array("Int32", "connectivity", 1, connectivity) +
          array("Int32", "offsets", 1, offsets) + array("UInt8", "types", 1, types) +
          "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return text;
}

std::string pvtu_text(const std::vector<std::string>& pieces,
                      const std::vector<std::string>& fields,
                      const std::vector<std::string>& cell_fields) {
  std::string text =
      file_head("PUnstructuredGrid") + "<PUnstructuredGrid GhostLevel=\"0\">\n<PPointData>\n";
  for (const std::string& field : fields)
    text += "<PDataArray type=\"Float32\" Name=\"" + field + "\"/>\n";
  text += "</PPointData>\n<PCellData>\n";
  for (const std::string& field : cell_fields)
    text += "<PDataArray type=\"Int32\" Name=\"" + field + "\"/>\n";
  text +=
      "</PCellData>\n<PPoints>\n<PDataArray type=\"Float32\" Name=\"Points\" "
      "NumberOfComponents=\"3\"/>\n</PPoints>\n";
  for (const std::string& piece : pieces) text += "<Piece Source=\"" + piece + "\"/>\n";
  return text + "</PUnstructuredGrid>\n</VTKFile>\n";
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& files) {
  std::string text = file_head("Collection") + "<Collection>\n";
  for (const auto& [time, file] : files)
    text +=
        "<DataSet timestep=\"" + format_number(time) + "\" part=\"0\" file=\"" + file + "\"/>\n";
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace traceraft::zlib
