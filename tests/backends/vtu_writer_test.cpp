#include "backends/zlib/vtu_writer.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "backends/zlib/checksum.hpp"
#include "kernel/fem/trace.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/thread_ranks.hpp"

namespace traceraft {
namespace {

std::string from_base64(const std::string& text) {
  static const std::string digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char ch : text) {
    if (ch == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(ch));
    if (++count % 4 != 1) bytes += static_cast<char>(bits >> (6 - 2 * ((count - 1) % 4)));
  }
  return bytes;
}

// Reads an array back as VTK does: base64 of the header, base64 of all blocks.
template <class T>
std::vector<T> array_named(const std::string& file, const std::string& name) {
  const std::size_t tag = file.find("Name=\"" + name + "\"");
  EXPECT_NE(tag, std::string::npos) << name;
  const std::size_t begin = file.find(">\n", tag) + 2, end = file.find('\n', begin);
  const std::string text = file.substr(begin, end - begin);
  std::uint64_t first[3];
  const std::string head = from_base64(text.substr(0, 32));
  std::memcpy(first, head.data(), sizeof first);
  const std::size_t header_bytes = (3 + first[0]) * 8, header_text = (header_bytes + 2) / 3 * 4;
  const std::string header = from_base64(text.substr(0, header_text));
  const std::string blocks = from_base64(text.substr(header_text));
  std::string data;
  std::size_t at = 0;
  for (std::uint64_t block = 0; block < first[0]; ++block) {
    std::uint64_t length;
    std::memcpy(&length, header.data() + 8 * (3 + block), 8);
    uLongf size = block + 1 < first[0] || first[2] == 0 ? first[1] : first[2];
    std::string plain(size, '\0');
    EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(plain.data()), &size,
                         reinterpret_cast<const Bytef*>(blocks.data() + at), length),
              Z_OK);
    data += plain;
    at += length;
  }
  std::vector<T> values(data.size() / sizeof(T));
  std::memcpy(values.data(), data.data(), values.size() * sizeof(T));
  return values;
}

TEST(VtuWriter, WritesTheSurfaceAndItsFields) {
  const auto space = testing::make_space(32);
  const Vec field = testing::random_vector(space->nodes(), 1);
  const Vec trace = fem::trace(*space, field);
  const std::string file = zlib::vtu_text(*space, 5.0, {{"c", trace}});
  const auto c = array_named<float>(file, "c");
  ASSERT_EQ(c.size(), space->surface.points.size());
  for (std::size_t p = 0; p < c.size(); ++p) ASSERT_EQ(c[p], static_cast<float>(trace[p]));
  const auto points = array_named<float>(file, "Points");
  for (std::size_t p = 0; p < c.size(); ++p)
    ASSERT_NEAR(std::hypot(points[3 * p], points[3 * p + 1], points[3 * p + 2]), 5.0, 0.02);
  const auto connectivity = array_named<std::int32_t>(file, "connectivity");
  ASSERT_EQ(connectivity.size(), 3 * space->surface.triangles.size());
  EXPECT_EQ(connectivity[5], space->surface.triangles[1][2]);
  EXPECT_EQ(array_named<std::uint8_t>(file, "types").size(), space->surface.triangles.size());
}

TEST(VtuWriter, WritesWholeNumbersOfTriangles) {
  const auto space = testing::make_space(16);
  std::vector<int> number(space->surface.triangles.size());
  for (std::size_t t = 0; t < number.size(); ++t) number[t] = static_cast<int>(t % 5);
  const std::string file = zlib::vtu_text(*space, 1.0, {}, {{"raft", number}});
  const std::size_t begin = file.find("<CellData>"), end = file.find("</CellData>");
  ASSERT_LT(begin, file.find("Name=\"raft\""));
  EXPECT_GT(end, file.find("Name=\"raft\""));
  const auto written = array_named<std::int32_t>(file, "raft");
  EXPECT_EQ(std::vector<int>(written.begin(), written.end()), number);
  EXPECT_NE(zlib::pvtu_text({"a.vtu"}, {"c"}, {"raft"})
                .find("<PCellData>\n<PDataArray type=\"Int32\" Name=\"raft\"/>"),
            std::string::npos);
}

TEST(VtuWriter, RanksWritePiecesOfTheWhole) {
  const auto whole = testing::make_space(16);
  std::size_t triangles = 0;
  std::mutex mutex;
  testing::run_on_ranks(3, [&](const auto& ranks) {
    const fem::SurfaceSpace part(geometry::make_surface("sphere"), 16,
                                 std::make_shared<ThreadTeam>(1), ranks);
    const Vec numbers = Vec::Constant(static_cast<Eigen::Index>(part.surface.points.size()), 7);
    const std::string file = zlib::vtu_text(part, 1.0, {{"c", numbers}});
    const auto points = array_named<float>(file, "Points");
    const auto connectivity = array_named<std::int32_t>(file, "connectivity");
    EXPECT_EQ(array_named<float>(file, "c").size(), points.size() / 3);
    for (const std::int32_t p : connectivity) ASSERT_LT(p, static_cast<int>(points.size() / 3));
    const std::lock_guard lock(mutex);
    triangles += connectivity.size() / 3;
  });
  EXPECT_EQ(triangles, whole->surface.triangles.size());
  const std::string joined = zlib::pvtu_text({"a.vtu", "b.vtu"}, {"c", "mu"});
  for (const char* part :
       {"PUnstructuredGrid", "Source=\"a.vtu\"", "Source=\"b.vtu\"", "Name=\"c\"", "Name=\"mu\""})
    EXPECT_NE(joined.find(part), std::string::npos) << part;
}

TEST(Checksum, IsCrc32) {
  EXPECT_EQ(zlib::crc32_of("123456789"), 0xCBF43926u);
}

}  // namespace
}  // namespace traceraft
