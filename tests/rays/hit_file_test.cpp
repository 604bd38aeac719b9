// Hit files, and rays as CSV: written files can be read back, and malformed files are refused with
// the place of the error.

#include "harness/rays/hit_file.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/rays/ray_file.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::rays {
namespace {

using scenes::says;

class HitFile : public ::testing::Test {
 protected:
  std::string refusal(const std::string& text) const {
    const auto file = folder_.write("some.hits", text);
    return scenes::thrown_message([&] { read(file); });
  }
  static HitTable read(const std::filesystem::path& file) {
    HitReader reader(file);
    HitTable hits;
    reader.read(1000, hits);
    return hits;
  }

  TemporaryFolder folder_;
};

TEST_F(HitFile, HoldsTheSameHitsInBothFormats) {
  accel::HitBuffer hits(5, 1, 1);
  hits.set(0, accel::Hit{0.1F, 3});
  hits.set(2, accel::Hit{std::nextafter(1.0F, 2.0F), 4'000'000'000U});
  hits.set(3, accel::Hit{1e-38F, 0});
  for (const char* name : {"a.hits", "a.csv"}) {
    const auto file = folder_.path() / name;
    write_hit_file(file, hits, {{"program", "mine"}});
    const HitTable found = read(file);
    ASSERT_EQ(found.t.size(), 5U) << name;
    ASSERT_EQ(found.primitives.size(), 5U) << name;
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(found.t[i], hits.t()[i]) << name;
      EXPECT_EQ(found.primitives[i], hits.primitive()[i]) << name;
    }
    EXPECT_EQ(HitReader(file).query(), Query::kClosestHit);
  }
  for (const char* name : {"any.hits", "any.csv"}) {
    const auto file = folder_.path() / name;
    write_hit_file(file, AnyHits{1, 0, 1}, {});
    EXPECT_EQ(read(file).occluded, (std::vector<std::uint8_t>{1, 0, 1})) << name;
    EXPECT_EQ(HitReader(file).query(), Query::kAnyHit) << name;
  }
}

TEST_F(HitFile, IsReadInPartsWithThePlacesOfItsHits) {
  const accel::HitBuffer hits(7, 1, 1);
  for (const auto& [name, place] :
       {std::pair("a.hits", "a.hits: byte "), std::pair("a.csv", "a.csv:6")}) {
    const auto file = folder_.path() / name;
    write_hit_file(file, hits, {});
    HitReader reader(file);
    HitTable part;
    for (const std::size_t expected : {3U, 3U, 1U, 0U}) EXPECT_EQ(reader.read(3, part), expected);
    EXPECT_TRUE(reader.place_of(4).find(place) != std::string::npos) << reader.place_of(4);
  }
  const std::string text = read_text(folder_.path() / "a.hits");
  const std::size_t begin = text.find("}\n") + 2;
  EXPECT_EQ(HitReader(folder_.path() / "a.hits").place_of(4),
            fmt::format("{}: byte {}", (folder_.path() / "a.hits").string(), begin + 4 * 8));
}

TEST_F(HitFile, AcceptsTheCsvDialectsOfPrograms) {
  const auto table = [&](const std::string& text) { return read(folder_.write("a.csv", text)); };
  const HitTable numpy = table("# t,primitive\n1.5e+00,7.000000000e+00\ninf,-1.0\n");
  EXPECT_EQ(numpy.t, (std::vector<float>{1.5F, accel::kInfinity}));
  EXPECT_EQ(numpy.primitives, (std::vector<std::uint32_t>{7, scenes::kNoPrimitive}));
  const HitTable spreadsheet = table("\xEF\xBB\xBF\"primitive\" , \"t\"\r\n7,+2\r\n,\r\n\r\n");
  EXPECT_EQ(spreadsheet.t, (std::vector<float>{2.0F, accel::kInfinity}));
  EXPECT_EQ(spreadsheet.primitives, (std::vector<std::uint32_t>{7, scenes::kNoPrimitive}));
  const HitTable quoted = table("\"T\",\"Primitive\"\n\"1.5\",\"7\"\n\"\",\" -1 \"\n");
  EXPECT_EQ(quoted.t, (std::vector<float>{1.5F, accel::kInfinity}));
  EXPECT_EQ(quoted.primitives, (std::vector<std::uint32_t>{7, scenes::kNoPrimitive}));
  const HitTable points = table("x,y,z,triangle\n1,2,3,0\n,,,\n1e-60,-INF,nan,4294967295");
  ASSERT_EQ(points.points.size(), 3U);
  EXPECT_EQ(points.points[0], glm::vec3(1, 2, 3));
  EXPECT_TRUE(std::isinf(points.points[1].z));
  EXPECT_EQ(points.points[2].x, 0.0F);
  EXPECT_TRUE(std::isnan(points.points[2].z));
  EXPECT_EQ(points.triangles[2], scenes::kNoPrimitive);
}

TEST_F(HitFile, ThatIsMalformedIsRefusedWithItsPlace) {
  for (const auto& [text, why] : std::vector<std::pair<std::string, std::string>>{
           {"", "this is not a hit file"},
           {"t,primitive\n", "it contains no hits"},
           {"t,id\n1,2\n", "some.hits:1: column 'id' is unknown"},
           {"t,t\n1,2\n", "some.hits:1: column 't' appears twice"},
           {"time,id\n1,2\n", "this is not a hit file"},
           {"t;primitive\n1;2\n", "some.hits:1: the columns are separated by semicolons"},
           {"t\tprimitive\n1\t2\n", "some.hits:1: the columns are separated by tabs"},
           {",t,primitive\n0,1,2\n", "some.hits:1: column 1 has no name"},
           {"primitive\n1\n", "some.hits:1: column 't' is missing"},
           {"x,y,primitive\n1,2,3\n", "some.hits:1: column 'z' is missing"},
           {"t,x,y,z\n1,2,3,4\n", "some.hits:1: the columns 't,x,y,z' cannot be combined"},
           {"t,primitive,triangle\n1,2,3\n", "cannot be combined"},
           {"t,occluded\n1,1\n", "cannot be combined"},
           {"t,primitive\n1,\"2,5\"\n", "some.hits:2: the line has 3 cells"},
           {"t,primitive\n\"1,2\n", "some.hits:2: column 't' contains '\"1'"},
           {"t,primitive\n1,2\nabc,3\n", "some.hits:3: column 't' contains 'abc'"},
           {"t,primitive\n1,2\n1,3,4\n", "some.hits:3: the line has 3 cells"},
           {"t,primitive\n1,2\n1\n", "some.hits:3: the line has 1 cells"},
           {"t,primitive\n1,2.5\n", "some.hits:2: column 'primitive' holds 2.5"},
           {"t,primitive\n1,-2\n", "some.hits:2: column 'primitive' holds -2"},
           {"t,primitive\n1,5000000000\n", "some.hits:2: column 'primitive' holds 5000000000"},
           {"t,primitive\n1,nan\n", "some.hits:2: column 'primitive' holds nan"},
           {"t,primitive\n1e999,1\n", "some.hits:2: column 't' contains '1e999'"},
           {"t,primitive\n1,2\n\n1,3\n", "some.hits:3: the line is blank"},
           {"occluded\n1\n\n", "some.hits:3: column 'occluded' contains ''"},
           {"occluded\n2\n", "some.hits:2: column 'occluded' holds 2"},
           {"beambench-hits 1", "the second line is not a JSON object"},
           {"beambench-hits 1\n7\n", "the second line is not a JSON object"},
           {"beambench-hits 1\n{\"hits\":0,\"columns\":[\"t\"]}\n", "\"hits\" is not"},
           {"beambench-hits 1\n{\"hits\":1}\n1234", "\"columns\" is not a list of names"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[3]}\n1234", "\"columns\" is not"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[\"u\"]}\n1234", "not a hit file"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[\"t\",\"u\"]}\n1234",
            "some.hits:2: column 'u'"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[\"t\"]}\n123",
            "3 bytes of hits follow the header; expected 4 for 1 hits"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[\"t\"]}\n12345", "5 bytes of hits"},
           {"beambench-hits 1\n{\"hits\":1,\"columns\":[\"t\",\"primitive\"]}\n1234",
            "4 bytes of hits follow the header; expected 8"},
           {"beambench-hits 2\n{}\n", "this is not a hit file"}}) {
    const std::string message = refusal(text);
    EXPECT_TRUE(says(message, {"some.hits", why})) << text << "\n" << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST_F(HitFile, RaysAsCsvAreTheSameRays) {
  RaySet set;
  set.rays = {{{0.1F, -2.0F, 3e-20F}, 0.5F, {0.0F, 0.0F, -1.0F}, 7.0F},
              {{1e8F, 0.0F, 0.0F}, 0.0F, {0.3F, 1e-30F, 2.0F}, accel::kInfinity}};
  const auto file = folder_.path() / "a.csv";
  write_ray_file(file, set, {});
  const RaySet found = read_ray_file(file);
  ASSERT_EQ(found.rays.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found.rays[i].origin, set.rays[i].origin);
    EXPECT_EQ(found.rays[i].direction, set.rays[i].direction);
    EXPECT_EQ(found.rays[i].t_min, set.rays[i].t_min);
    EXPECT_EQ(found.rays[i].t_max, set.rays[i].t_max);
  }
  const RaySet least = read_ray_file(folder_.write("b.csv", "dx,dy,dz,ox,oy,oz\n1,0,0,4,5,6\n"));
  EXPECT_EQ(least.rays.at(0).origin, glm::vec3(4, 5, 6));
  EXPECT_EQ(least.rays[0].t_min, 0.0F);
  EXPECT_EQ(least.rays[0].t_max, accel::kInfinity);
  const RaySet quoted = read_ray_file(
      folder_.write("c.csv", "\"OX\",OY,Oz,T_MIN,dx,dy,dz\n\"4\",\"5\",6,\"\",\"1e0\",0,0\n"));
  EXPECT_EQ(quoted.rays.at(0).origin, glm::vec3(4, 5, 6));
  EXPECT_EQ(quoted.rays[0].direction, glm::vec3(1, 0, 0));
  EXPECT_EQ(quoted.rays[0].t_min, 0.0F);
}

TEST_F(HitFile, RaysAsCsvThatAreMalformedAreRefusedWithTheirLine) {
  const std::string columns = "ox,oy,oz,t_min,dx,dy,dz,t_max\n";
  for (const auto& [text, why] : std::vector<std::pair<std::string, std::string>>{
           {"time,place\n1,2\n", "this is not a ray file"},
           {"0,0,0,0,0,0,1,inf\n", "this is not a ray file"},
           {"ox,oy,oz,dx,dy\n1,2,3,4,5\n", "a.csv:1: column 'dz' is missing"},
           {"ox,oy,oz,dx,dy,dz,dz\n", "a.csv:1: column 'dz' appears twice"},
           {"ox,oy,oz,dx,dy,DZ,dz\n", "a.csv:1: column 'dz' appears twice"},
           {"index," + columns, "a.csv:1: column 'index' is unknown; remove it"},
           {"Index," + columns, "a.csv:1: column 'Index' is unknown; remove it"},
           {"," + columns, "a.csv:1: column 1 has no name"},
           {"ox,oy,oz,tmin,dx,dy,dz\n", "column 'tmin' is unknown; did you mean 't_min'?"},
           {"ox;oy;oz;dx;dy;dz\n0;0;0;0;0;1\n", "a.csv:1: the columns are separated by semicolons"},
           {"\"ox\";\"oy\";\"dz\"\n", "a.csv:1: the columns are separated by semicolons"},
           {"ox\toy\toz\tdx\tdy\tdz\n", "a.csv:1: the columns are separated by tabs"},
           {"# ox oy oz dx dy dz\n0 0 0 0 0 1\n", "a.csv:1: the columns are separated by blanks"},
           {columns, "it contains no rays"},
           {columns + "0,0,0,0,0,0,1,inf\n0,0,0,0,0,0,0,inf\n", "a.csv:3: "},
           {columns + "nan,0,0,0,0,0,1,inf\n", "a.csv:2: "},
           {columns + "0,0,0,-1,0,0,1,inf\n", "a.csv:2: "},
           {columns + "0,0,,0,0,0,1,inf\n", "a.csv:2: column 'oz' contains ''"},
           {columns + "0,0,0,0,0,0,1\n", "a.csv:2: the line has 7 cells"}}) {
    const auto file = folder_.write("a.csv", text);
    const std::string message = scenes::thrown_message([&] { read_ray_file(file); });
    EXPECT_TRUE(says(message, {"a.csv", why})) << text << "\n" << message;
  }
}

}  // namespace
}  // namespace beambench::rays
