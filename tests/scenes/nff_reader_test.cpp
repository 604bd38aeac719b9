#include "scenes/formats/nff/nff_reader.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

const std::string kFolder = std::string(BEAMBENCH_TEST_FILES) + "/golden/nff/";

nff::NffResult parse(std::string_view text) { return nff::parse_nff(text, "test.nff"); }

TEST(NffReader, RefusesASceneThatIsTooSmall) {
  EXPECT_NO_THROW(parse("s 0 0 0 1e-8\n"));
  EXPECT_TRUE(says(thrown_message([] { parse("s 0 0 0 1e-15\n"); }), {"test.nff", "scale it up"}));
}

TEST(NffReader, ReadsOneOfEverything) {
  const nff::NffResult result = nff::read_nff(kFolder + "complete.nff");
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {":25: ", "normal of length 0"}));
  const Scene& scene = result.scene;
  EXPECT_EQ(scene.background, glm::vec3(0.078F, 0.361F, 0.753F));

  ASSERT_EQ(scene.cameras.size(), 1U);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.from, glm::vec3(2.1F, 1.3F, 1.7F));
  EXPECT_EQ(camera.at, glm::vec3(0.0F));
  EXPECT_EQ(camera.up, glm::vec3(0, 0, 1));
  EXPECT_EQ(camera.angle, 45.0F);
  EXPECT_EQ(camera.aspect, 1.0F);
  EXPECT_EQ(camera.hither, 0.01F);
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 480);

  ASSERT_EQ(scene.lights.size(), 2U);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1.0F));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(0.5F, 0.25F, 20.0F));

  ASSERT_EQ(scene.primitives.size(), 6U);
  EXPECT_EQ(scene.spheres[0].radius, 0.5F);
  EXPECT_TRUE(scene.spheres[1].inside_only);
  EXPECT_EQ(scene.cones[0].apex, glm::vec3(0, 0, 2));
  EXPECT_EQ(scene.cones[0].apex_radius, 0.05F);
  EXPECT_TRUE(scene.cones[1].inside_only);
  EXPECT_EQ(scene.cones[1].base_radius, 0.1F);
  EXPECT_EQ(scene.polygons[0].corner_count, 4U);
  EXPECT_EQ(scene.polygons[0].first_normal, Polygon::kFlat);
  ASSERT_NE(scene.polygons[1].first_normal, Polygon::kFlat);
  EXPECT_EQ(scene.normals[1], glm::vec3(0, 1, 1));
  EXPECT_EQ(scene.normals[2], glm::vec3(0, 0, 1))
      << "a normal of length 0 is replaced by the polygon's own";

  const Surface& surface = scene.surfaces[scene.primitives[1].surface];
  EXPECT_EQ(surface.color, glm::vec3(1.0F, 0.9F, 0.7F));
  EXPECT_EQ(surface.diffuse, 0.5F);
  EXPECT_EQ(surface.specular, 0.5F);
  EXPECT_EQ(surface.shine, 3.0827F);
  EXPECT_EQ(surface.transmittance, 0.0F);
  EXPECT_EQ(surface.refraction_index, 1.5F);
  EXPECT_EQ(scene.surfaces[scene.primitives[0].surface].diffuse, 0.8F);
}

TEST(NffReader, ReadsFilesFromTheWild) {
  const std::string file = kFolder + "quirks.nff";
  const nff::NffResult result = nff::read_nff(file);
  const Scene& scene = result.scene;
  EXPECT_EQ(scene.name, file);
  ASSERT_EQ(scene.spheres.size(), 2U);
  EXPECT_EQ(scene.spheres[0].center, glm::vec3(1.5e-5F, -20.0F, 3.0F));
  EXPECT_EQ(scene.spheres[1].center.z, 0.0F) << "1e-400";
  ASSERT_EQ(scene.polygons.size(), 1U);
  EXPECT_EQ(scene.surfaces[1].shine, 100000.0F);
  EXPECT_EQ(scene.surfaces[0].diffuse, 1.0F) << "f with three fields";
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(scene.cameras.size(), 1U) << "a camera is fitted where there is no view";
  ASSERT_EQ(result.warnings.size(), 4U);
  EXPECT_TRUE(says(result.warnings[0], {file + ":1: ", "'From'", "line 5"}));
  EXPECT_TRUE(says(result.warnings[1], {file + ":8: ", "'obj'", "line 10"}));
  EXPECT_TRUE(says(result.warnings[2], {file + ":10: ", "ninth field"}));
  EXPECT_TRUE(says(result.warnings[3], {file + ":12: ", "'st'", "line 13"}));
}

TEST(NffReader, CatalogForwardsTheWarnings) {
  std::vector<std::string> warnings;
  const Scene scene = load_scene(kFolder + "quirks.nff", &warnings);
  EXPECT_EQ(scene.primitives.size(), 3U);
  EXPECT_EQ(warnings.size(), 4U);
  EXPECT_TRUE(
      says(thrown_message([] { load_scene(kFolder + "quirks.nff", nullptr, {.strict = true}); }),
           {"quirks.nff:1: ", "'From'"}));
}

TEST(NffReader, WordsOfTheThesisApplyUntilTheNext) {
  const nff::NffResult result = nff::read_nff(kFolder + "thesis.nff");
  EXPECT_TRUE(result.warnings.empty());
  const Scene& scene = result.scene;
  ASSERT_EQ(scene.spheres.size(), 14U);
  EXPECT_EQ(scene.surfaces.size(), 13U);
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const auto number = static_cast<int>(scene.spheres[i].center.x);
    const Surface& surface = scene.surfaces[scene.primitives[i].surface];
    EXPECT_EQ(static_cast<int>(surface.finish), number % 13);
    if (number == 13) continue;  // the last is of `f`
    EXPECT_EQ(surface, finished_surface(static_cast<Finish>(number)));
  }
  EXPECT_EQ(scene.surfaces.back(), (Surface{.color = {1, 0, 0}, .diffuse = 0.5F}));
}

TEST(NffReader, WordsOfTheThesisCanHaveNumbers) {
  const Scene scene = parse("texclouds 1 .5 0 .25\ns 0 0 0 1\ntexclouds\ns 0 0 0 1\n").scene;
  Surface tinted = finished_surface(Finish::kClouds);
  tinted.color = {1, 0.5F, 0};
  tinted.diffuse = 0.25F;
  ASSERT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.surfaces[0], tinted);
  EXPECT_EQ(scene.surfaces[1], finished_surface(Finish::kClouds));
}

TEST(Finish, EachHasItsWordAndItsNumbers) {
  for (int i = 1; i < 13; ++i) {
    const auto finish = static_cast<Finish>(i);
    EXPECT_EQ(find_finish(finish_word(finish)), finish);
    EXPECT_EQ(finished_surface(finish).finish, finish);
  }
  EXPECT_EQ(finished_surface(Finish::kPlain), Surface{});
  EXPECT_FALSE(find_finish("f"));
  EXPECT_FALSE(find_finish("texgranite"));
  EXPECT_GT(finished_surface(Finish::kReflect).specular, 0.5F);
  EXPECT_GT(finished_surface(Finish::kGlass).transmittance, 0.5F);
  EXPECT_GT(finished_surface(Finish::kGlass).refraction_index, 1.0F);
}

/// Uses words of other programs before, between and after commands, which must still be read.
class PrivateWord : public testing::TestWithParam<const char*> {};

TEST_P(PrivateWord, IsSkippedAndReportedOnce) {
  const std::string line = std::string(GetParam()) + " 1 2.5 name\n";
  std::string quoted = GetParam();
  quoted.insert(0, 1, '\'').push_back('\'');
  const std::string text = "b 0 0 0\n" + line + "s 0 0 0 1\n" + line + "  7 8\n" + line +
                           "p 3\n0 0 0\n1 0 0\n0 1 0\n" + line;
  const nff::NffResult result = parse(text);
  EXPECT_EQ(result.scene.primitives.size(), 2U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {"test.nff:2: ", quoted, "line 3", "(and 2 more)"}));
  EXPECT_TRUE(says(thrown_message([&] { nff::parse_nff(text, "test.nff", {.strict = true}); }),
                   {"test.nff:2: ", quoted, "--strict"}));
}

INSTANTIATE_TEST_SUITE_P(NffReader, PrivateWord,
                         testing::Values("number", "g", "fp", "t", "st", "obj", "tess"),
                         [](const auto& info) { return std::string(info.param); });

TEST(NffReader, SurfacesHaveThreeToNineFields) {
  const std::array<const char*, 6> fields = {" .1", " .2", " 100000", " .4", " 1.5", " 9"};
  std::string text = "f .7 .8 .9";
  for (std::size_t given = 0; given <= fields.size(); ++given) {
    if (given > 0) text += fields[given - 1];
    const nff::NffResult result = parse(text + "\ns 0 0 0 1\n");
    const Surface& surface = result.scene.surfaces.at(0);
    EXPECT_EQ(surface.color, glm::vec3(0.7F, 0.8F, 0.9F));
    EXPECT_EQ(surface.diffuse, given > 0 ? 0.1F : 1.0F);
    EXPECT_EQ(surface.specular, given > 1 ? 0.2F : 0.0F);
    EXPECT_EQ(surface.shine, given > 2 ? 100000.0F : 0.0F);
    EXPECT_EQ(surface.transmittance, given > 3 ? 0.4F : 0.0F);
    EXPECT_EQ(surface.refraction_index, given > 4 ? 1.5F : 1.0F);
    EXPECT_EQ(result.warnings.size(), given > 5 ? 1U : 0U) << "the ninth is ignored";
  }
}

TEST(NffReader, DefaultsAreBlackBehindWhiteLights) {
  const Scene scene = parse("s 0 0 0 1\nl 1 2 3\nl 4 5 6 20 0 0\n").scene;
  EXPECT_EQ(scene.background, glm::vec3(0.0F));
  ASSERT_EQ(scene.lights.size(), 2U) << "lights after objects";
  EXPECT_EQ(scene.lights[0].color, glm::vec3(1.0F));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(20, 0, 0));
}

TEST(NffReader, NumbersAreRoundedOnce) {
  // Via double, 7.038531e-26 would become the next float, because of double rounding at a tie.
  const Scene scene = parse("s 7.038531e-26 1.5e-005 1E+004 2.5e000\ns 0 1e-60 -.0 1\n").scene;
  EXPECT_EQ(scene.spheres[0].center, glm::vec3(7.038531e-26F, 1.5e-5F, 1e4F));
  EXPECT_EQ(scene.spheres[0].radius, 2.5F);
  EXPECT_EQ(scene.spheres[1].center.y, 0.0F);
  const std::string tiny = std::string("0.").append(60, '0') + "1";
  EXPECT_EQ(parse("s -" + tiny + " 0 0 1\n").scene.spheres[0].center.x, 0.0F);
}

TEST(NffReader, DegeneratePrimitivesAreSkippedAndCounted) {
  const char* text =
      "s 0 0 0 1\n"
      "p 3\n0 0 0\n1 1 1\n2 2 2\n"
      "s 1 1 1 1e-60\n"
      "c 0 0 0 0 1 1 1 0\n"
      "c 1 1 1 1 1 1 1 1\n"
      "p 2\n0 0 0\n1 1 1\n"
      "pp 4\n0 0 0 0 0 1\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 0 0 0 0 1\n"
      "s 3 0 0 2\n";
  const nff::NffResult result = parse(text);
  ASSERT_EQ(result.scene.primitives.size(), 2U);
  EXPECT_EQ(result.scene.spheres[1].radius, 2.0F);
  EXPECT_TRUE(result.scene.vertices.empty()) << "a skipped polygon leaves no vertices";
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {"test.nff:2: ", "degenerate", "skipped",
                                        "polygon (primitive 1)", "no area", "(and 5 more)"}));
  EXPECT_TRUE(says(thrown_message([&] { nff::parse_nff(text, "test.nff", {.strict = true}); }),
                   {"test.nff:2: polygon (primitive 1): ", "no area", "--strict"}));
}

TEST(NffReader, OneDegenerateTriangleOfManyIsAccepted) {
  std::string text;
  for (int i = 0; i < 1844; ++i) {
    const std::string x = std::to_string(i);
    text += "p 3\n" + x + " 0 0\n" + x + " 1 0\n" + x + (i == 900 ? " 2 0\n" : " 0 1\n");
  }
  const nff::NffResult result = parse(text);
  EXPECT_EQ(result.scene.primitives.size(), 1843U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {"test.nff:3601: ", "polygon (primitive 900)"}));
}

// Words of dialects

TEST(NffReader, FillOfPhongSurfacesHasTheFieldsOfF) {
  const std::string fields = " .2 .4 .6 .1 .9 64 0.5 1.5\ns 0 0 0 1\n";
  const nff::NffResult result = parse("fp" + fields);
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_EQ(result.scene.surfaces, parse("f" + fields).scene.surfaces);
  EXPECT_EQ(result.scene.surfaces[0].color, glm::vec3(.2F, .4F, .6F));
}

TEST(NffReader, AreaLightsBecomePointsInFrontOfTheirCenters) {
  const nff::NffResult result =
      parse("la 4 10 4  2 0 0  0 0 8  5 4 3\nla 0 0 0 1 0 0 0 1 0\ns 0 0 0 1\nl 1 2 3\n");
  const std::vector<Light>& lights = result.scene.lights;
  ASSERT_EQ(lights.size(), 3U);
  EXPECT_EQ(lights[0].color, glm::vec3(5, 4, 3));
  // The cross product of the x and z edges points down: a lamp in the ceiling lights the room.
  EXPECT_EQ(lights[0].position, glm::vec3(5.0F, 9.996F, 8.0F));
  EXPECT_EQ(lights[1].color, glm::vec3(1.0F));
  EXPECT_EQ(lights[1].position, glm::vec3(0.5F, 0.5F, 0.001F));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(
      says(result.warnings[0], {"test.nff:1: ", "area light", "point light", "(and 1 more)"}));
  EXPECT_EQ(parse("s 0 0 0 1\nla 0 0 0 1 0 0 0 1 0").scene.lights.size(), 1U);
}

TEST(NffReader, AnimatedLightsStayAtTheirFirstPosition) {
  const nff::NffResult result =
      parse("la lamp 4 10 4\nla sun-2 1 2 3 .5 .25 1\ns 0 0 0 1\nl 1 2 3\n");
  const std::vector<Light>& lights = result.scene.lights;
  ASSERT_EQ(lights.size(), 3U);
  EXPECT_EQ(lights[0].position, glm::vec3(4, 10, 4));
  EXPECT_EQ(lights[0].color, glm::vec3(1.0F));
  EXPECT_EQ(lights[1].position, glm::vec3(1, 2, 3));
  EXPECT_EQ(lights[1].color, glm::vec3(.5F, .25F, 1));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {"test.nff:1: ", "static light", "(and 1 more)"}));
}

TEST(NffReader, CountsAreNotRoundedToFloat) {
  EXPECT_TRUE(says(thrown_message([] { parse("p 16777217\n0 0 0\n"); }), {"16777217"}));
}

TEST(NffReader, StrictReadingRefusesWhatItWouldRepair) {
  struct Case {
    const char* text;
    std::size_t line;
    const char* words;
  };
  for (const Case& wrong :
       {Case{"hello\ns 0 0 0 1\n", 1, "'hello'"},
        Case{"b 0 0 0\nf 1 1 1 1 0 0 0 1 7\ns 0 0 0 1\n", 2, "ninth"},
        Case{"p 4\n0 0 0\n0 0 0\n1 0 0\n0 1 0\n", 1, "same place"},
        Case{"pp 3\n0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n", 1, "normal of length 0"}}) {
    EXPECT_EQ(parse(wrong.text).warnings.size(), 1U) << wrong.text;
    EXPECT_TRUE(
        says(thrown_message([&] { nff::parse_nff(wrong.text, "test.nff", {.strict = true}); }),
             {"test.nff:" + std::to_string(wrong.line) + ": ", wrong.words}));
  }
}

TEST(NffReader, OnlySignificantLayoutMatters) {
  const std::uint64_t hash = scene_hash(parse("s 1 2 3 4\nc 0 0 0 1 0 0 1 2\n").scene);
  for (const char* text :
       {"s 1 2 3 4\r\nc 0 0 0 1 0 0 1 2", "s\n1\n2\n3\n4\nc\n0 0 0 1\n0 0 1 2\n",
        "  s 1 2#x\n3 4#\nc 0 0 0 1# s 1 1 1 1\n0 0 1 2\n#",
        "\n\n#c 1\ns\t1.0 .2e1 +3 4.\nc 0 0 -0.0e9 1 0 0 1 2",
        "# a\rs 1 2 3 4 # b\rc 0 0 0 1\r0 0 1 2\r", "s 1 2 3 4\rc 0 0 0 1 0 0 1 2"}) {
    EXPECT_EQ(scene_hash(parse(text).scene), hash) << text;
  }
}

TEST(NffReader, LinesOfEveryEndAreCounted) {
  EXPECT_TRUE(says(thrown_message([] { parse("b 0 0 0\r\r\ns 0 0 0 1\rs 0 0 zero 1\r"); }),
                   {"test.nff:4: ", "'zero'"}));
}

TEST(NffReader, BlocksOfZeroBytesAreReported) {
  const std::string text = "s 0 0 0 1\n" + std::string(4096, '\0') + "\ns 0 0 0 2\n";
  const nff::NffResult result = parse(text);
  EXPECT_EQ(result.scene.primitives.size(), 2U);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(says(result.warnings[0], {"test.nff:2: ", "unknown word '\\x00"}));
}

TEST(NffReader, LaterViewsAreFurtherCameras) {
  const std::string view = "v\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 40\nresolution 8 8\n";
  const Scene scene = parse(view + view + "s 0 0 0 1\n").scene;
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "default");
  EXPECT_EQ(scene.cameras[1].name, "view 2");
}

TEST(NffReader, OurOwnCommentsGiveNameAndAspect) {
  const std::string view = "v\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 40\nresolution 8 8\n";
  const nff::NffResult result = parse(view +
                                      "#beambench name  from the side  # the left one\r\n"
                                      " #beambench aspect 1.5\n"
                                      "#beambench\n#beambenchs 0 0 0 1\n# #beambench s 0 0 0 2\n"
                                      "s 0 0 0 3 #beambench s 0 0 0 4\n");
  EXPECT_TRUE(result.warnings.empty());
  EXPECT_EQ(result.scene.cameras[0].name, "from the side");
  EXPECT_EQ(result.scene.cameras[0].aspect, 1.5F);
  ASSERT_EQ(result.scene.spheres.size(), 1U);
  EXPECT_EQ(result.scene.spheres[0].radius, 3.0F);
}

struct Malformed {
  const char* name;
  std::string_view text;
  std::size_t line;
  const char* words;
};

void PrintTo(const Malformed& malformed, std::ostream* stream) { *stream << malformed.name; }

class MalformedNff : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedNff, IsRefusedWithFileLineAndWord) {
  EXPECT_TRUE(says(thrown_message([] { parse(GetParam().text); }),
                   {"test.nff:" + std::to_string(GetParam().line) + ": ", GetParam().words}));
}

INSTANTIATE_TEST_SUITE_P(
    NffReader, MalformedNff,
    testing::Values(
        Malformed{"empty", "", 1, "no NFF command"},
        Malformed{"no_command", "hello\nworld 1 2\n", 1, "no NFF command"},
        Malformed{"sense8", "# x\nNFF\nversion 2.00\n", 2, "Sense8"},
        Malformed{"sense8_lower_case", "nff\nversion 2.00\n", 1, "Sense8"},
        Malformed{"cut_in_sphere", "b 0 0 0\ns 0 0", 2, "ends where the sphere's center"},
        Malformed{"cut_before_radius", "s 0 0 0\n\n", 3, "ends where the sphere's radius"},
        Malformed{"cut_in_polygon", "p 3\n0 0 0\n1 0 0\n0 1", 1, "cut off"},
        Malformed{"next_command_too_early", "s 0 0 0\ns 0 0 0 1\n", 2, "found 's' where"},
        Malformed{"not_a_number", "s 0 0 0 1\ns 0 0 zero 1\n", 2, "'zero'"},
        Malformed{"half_a_number", "s 0 0 0 1.2.3\n", 1, "'1.2.3'"},
        Malformed{"decimal_comma", "s 0,5 0 0 1\n", 1, "'0,5'"},
        Malformed{"nan", "b 0 0 0\nl 1 nan 2\n", 2, "'nan'"},
        Malformed{"negative_nan_color", "l 1 1 2 -nan 1 1\n", 1, "'-nan'"},
        Malformed{"inf", "s 0 0 inf 1\n", 1, "'inf'"},
        Malformed{"too_large_for_double", "s 0 0 1e999 1\n", 1, "'1e999'"},
        Malformed{"beyond_limit", "\ns 0 0 1.1e9 1\n", 2, "'1.1e9'"},
        Malformed{"cone_of_mixed_radii", "c 0 0 0 1\n1 1 1 -1\n", 1, "differ in sign"},
        Malformed{"polygon_of_minus_one", "p -1\n", 1, "at least 3"},
        Malformed{"polygon_of_a_billion", "b 0 0 0\np 1000000000\n0 0 0\n1 0 0\n0 1 0\n", 2,
                  "a polygon of 1000000000 vertices"},
        Malformed{"smooth_polygon_of_a_billion", "pp 1000000000\n0 0 0\n", 1, "can hold"},
        Malformed{"count_beyond_limit", "p 99999999999999\n0 0 0\n", 1, "number of vertices"},
        Malformed{"count_not_whole", "p 3.5\n0 0 0\n", 1, "integer"},
        Malformed{"count_missing", "p\nfoo", 2, "number of vertices"},
        Malformed{"count_too_small", "p 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\ns 0 0 0 1\n", 5,
                  "line 1 takes fewer numbers"},
        Malformed{"zeros_in_a_sphere", std::string_view("s 0 0 \0\0 1\n", 10), 1, "'\\x00\\x00'"},
        Malformed{"nan_in_what_would_be_skipped", "s 0 0 0 1\nc 0 0 0 0\n1 nan 1 0\n", 3, "'nan'"},
        Malformed{"cut_in_what_would_be_skipped", "s 0 0 0 1\np 3\n0 0 0\n0 0 0\n0 0", 2,
                  "cut off"},
        Malformed{"polygon_of_none", "s 0 0 0 1\np 0\n", 2, "at least 3"},
        Malformed{"area_light_cut_off", "s 0 0 0 1\nla 0 0 0 1 0 0 0 1\n", 2, "'la' has 8 numbers"},
        Malformed{"area_light_cut_in_its_color", "la 0 0 0 1 0 0 0 1 0 .5 .5", 1, "11 numbers"},
        Malformed{"light_of_no_dialect", "b 0 0 0\nla 1 2 3\nl 1 2 3\ns 0 0 0 1\n", 2,
                  "'la' has 3 numbers, but"},
        Malformed{"light_without_anything", "la\ns 0 0 0 1\n", 1, "'la' has 0 numbers"},
        Malformed{"animated_light_without_place", "la lamp 1 2\ns 0 0 0 1\n", 2,
                  "the light's position"},
        Malformed{"area_light_nan", "s 0 0 0 1\nla 0 0 0 1 0 0 0 1 nan\nb 0 0 0\n", 2, "'nan'"},
        Malformed{"too_many_surface_fields", "f 1 1 1 1 1 1 1 1 1\n2\n", 2, "'2'"},
        Malformed{"too_few_surface_fields", "f 1 1\ns 0 0 0 1\n", 2, "the color"},
        Malformed{"light_with_half_a_color", "l 1 1 1 1\ns 0 0 0 1", 2, "light's color"},
        Malformed{"obj_file", "v 1 2 3\nv 2 3 4\nf 1 2 3\n", 1, "no 'from'"},
        Malformed{"view_without_at", "b 0 0 0\nv\nfrom 1 1 1\nup 0 0 1\n", 2, "no 'at'"},
        Malformed{"cut_in_view", "v\nfrom 1 1 1\nat 0 0 0\nup 0 0 1\nangle 45\n", 1,
                  "no 'resolution'"},
        Malformed{"view_at_itself", "v\nfrom 1 1 1\nat 1 1 1\nup 0 0 1\nangle 45\nresolution 4 4\n",
                  1, "the eye is the point looked at"},
        Malformed{"view_angle", "v\nfrom 1 1 1\nat 0 0 0\nup 0 0 1\nangle 180\nresolution 4 4\n", 1,
                  "between 0 and 180"},
        Malformed{"view_without_the_name_it_begins", "b 0 0 0\nv\n#beambench name\nfrom 1 1 1\n", 3,
                  "camera's name"},
        Malformed{"view_aspect",
                  "v\nfrom 1 1 1\nat 0 0 0\nup 0 0 1\nangle 45\nresolution 4 4\n"
                  "#beambench aspect 0\n",
                  1, "aspect is 0"},
        Malformed{"finish_with_half_a_color", "surfglass 1 1\ns 0 0 0 1\n", 2, "the color"},
        Malformed{"view_resolution",
                  "v\nfrom 1 1 1\nat 0 0 0\nup 0 0 1\nangle 45\nresolution 0 4\n", 1, "0 x 4"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(NffReader, UnreadableFilesAreRefused) {
  EXPECT_TRUE(says(thrown_message([] { nff::read_nff("/no/such/file.nff"); }),
                   {"/no/such/file.nff", "No such file"}));
  EXPECT_TRUE(says(thrown_message([] { nff::read_nff(kFolder); }), {kFolder, "folder"}));
}

/// Parses arbitrary text: the result is a scene or an InputError that names the place.
void expect_scene_or_refusal(const std::string& text) {
  try {
    const Scene scene = parse(text).scene;
    RC_ASSERT(scene.cameras.size() >= 1U);
    for (const Sphere& sphere : scene.spheres) {
      RC_ASSERT(sphere.radius > 0.0F && std::abs(sphere.center.x) <= 1e9F);
    }
    for (const Polygon& polygon : scene.polygons) RC_ASSERT(polygon.triangle_count > 0U);
  } catch (const InputError& error) {
    RC_ASSERT(std::string(error.what()).starts_with("test.nff:"));
  }
}

std::string golden(const std::string& name) {
  std::ifstream stream(kFolder + name, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

RC_GTEST_PROP(NffReader, TruncatedTextGivesASceneOrARefusal, ()) {
  const std::string whole = golden(*rc::gen::element("complete.nff", "quirks.nff"));
  expect_scene_or_refusal(whole.substr(0, *rc::gen::inRange<std::size_t>(0, whole.size())));
}

RC_GTEST_PROP(NffReader, MutatedTextGivesASceneOrARefusal, (std::uint64_t seed)) {
  static constexpr std::array<std::string_view, 16> kPieces = {
      "nan",      "-",         "1e9", "\n", " ",   "#",      "p 1000000000",
      "pp 3\n",   "v\n",       "0",   "s ", "c\n", "1e-999", std::string_view("\0", 1),
      "\xFF\xFE", "9999999999"};
  Random random(seed);
  std::string text = golden(random.below(2) == 0 ? "complete.nff" : "quirks.nff");
  const std::uint64_t mutations = 1 + random.below(8);
  for (std::uint64_t i = 0; i < mutations; ++i) {
    const std::size_t at = random.below(text.size());
    const std::size_t length = std::min<std::size_t>(random.below(12), text.size() - at);
    switch (random.below(3)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, kPieces[random.below(kPieces.size())]);
        break;
      default:
        text[at] = static_cast<char>(random.below(256));
    }
    if (text.empty()) break;
  }
  expect_scene_or_refusal(text);
}

RC_GTEST_PROP(NffReader, AnyTextGivesASceneOrARefusal, (const std::string& text)) {
  expect_scene_or_refusal(text);
}

TEST(NffReader, TenMegabytesTakeWellUnderASecond) {
  Random random(1);
  std::ostringstream text;
  for (int i = 0; i < 120000; ++i) {
    text << "p 3\n";
    for (int k = 0; k < 9; ++k) text << random.uniform(-1, 1) << (k % 3 == 2 ? '\n' : ' ');
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(parse(text.str()).scene.polygons.size(), 120000U);
  // About 100 ms in a release build; the bound only catches quadratic work.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

}  // namespace
}  // namespace beambench::scenes
