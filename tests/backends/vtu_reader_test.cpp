#include "backends/zlib/vtu_reader.hpp"

#include <gtest/gtest.h>

#include "backends/zlib/vtk_array.hpp"
#include "backends/zlib/vtu_writer.hpp"
#include "kernel/core/error.hpp"
#include "kernel/fem/trace.hpp"
#include "tests/support/spaces.hpp"

namespace traceraft {
namespace {

TEST(VtuReader, ReadsWhatIsWritten) {
  const auto space = testing::make_space(12);
  Vec c(space->nodes());
  for (int i = 0; i < space->nodes(); ++i) c[i] = space->mesh.position(i)[0];
  const Vec values = fem::trace(*space, c);
  const zlib::SurfaceField field =
      zlib::read_vtu(zlib::vtu_text(*space, 5, {{"mu", -values}, {"c", values}}), "c");
  ASSERT_EQ(field.values.size(), values.size());
  EXPECT_LT((field.values - values).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_EQ(field.mesh.triangles, space->surface.triangles);
  for (std::size_t p = 0; p < field.mesh.position.size(); ++p)
    EXPECT_LT((field.mesh.position[p] - 5 * space->surface.position[p]).norm(), 1e-5);
}

TEST(VtkArray, RefusesPaddingThatCannotBe) {
  const std::string text = zlib::encoded_array("abcdefgh", 8);
  EXPECT_EQ(zlib::decoded_array(text), "abcdefgh");
  EXPECT_THROW((void)zlib::decoded_array(text.substr(0, 44) + "===="), IoError);
  EXPECT_THROW((void)zlib::decoded_array(text + "===="), IoError);
  EXPECT_THROW((void)zlib::decoded_array("============"), IoError);
  for (std::size_t at = 0; at < text.size(); ++at) {
    std::string broken = text;
    broken[at] = '=';
    try {
      EXPECT_EQ(zlib::decoded_array(broken).size(), 8u) << at;
    } catch (const IoError&) {
    }
  }
}

TEST(VtuReader, RefusesWhatIsDamaged) {
  const auto space = testing::make_space(12);
  const Vec values = Vec::Ones(static_cast<Eigen::Index>(space->surface.points.size()));
  const std::string text = zlib::vtu_text(*space, 1, {{"c", values}});
  EXPECT_THROW((void)zlib::read_vtu("", "c"), IoError);
  EXPECT_THROW((void)zlib::read_vtu(text, "mu"), IoError);
  for (std::size_t at = 400; at < text.size(); at += text.size() / 40) {
    std::string broken = text;
    broken[at] = broken[at] == '!' ? '?' : '!';
    try {  // either it is seen or it was not in what is read
      const zlib::SurfaceField field = zlib::read_vtu(broken, "c");
      EXPECT_EQ(field.values, values);
    } catch (const IoError&) {
    }
    if (at < text.find("offsets")) {  // what comes after it is not read
      EXPECT_THROW((void)zlib::read_vtu(text.substr(0, at), "c"), IoError);
    }
  }
}

TEST(VtuReader, FollowsCollections) {
  const auto files =
      zlib::files_of_pvd(zlib::pvd_text({{0, "fields/a.vtu"}, {2.5, "fields/b.pvtu"}}));
  ASSERT_EQ(files.size(), 2u);
  EXPECT_DOUBLE_EQ(files[1].first, 2.5);
  EXPECT_EQ(files[1].second, "fields/b.pvtu");
  EXPECT_EQ(zlib::pieces_of_pvtu(zlib::pvtu_text({"p0.vtu", "p1.vtu"}, {"c"})),
            (std::vector<std::string>{"p0.vtu", "p1.vtu"}));
}

TEST(VtkArray, RoundTripsAnyLength) {
  for (const std::size_t size : {0u, 1u, 2u, 3u, 100u, 65535u, 65536u, 65537u, 200000u}) {
    std::string data(size, '\0');
    for (std::size_t i = 0; i < size; ++i) data[i] = static_cast<char>(i * i / 7);
    EXPECT_EQ(zlib::decoded_array(zlib::encoded_array(data.data(), data.size())), data) << size;
  }
}

}  // namespace
}  // namespace traceraft
