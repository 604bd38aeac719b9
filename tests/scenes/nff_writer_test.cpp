#include "scenes/formats/nff/nff_writer.hpp"

#include <bit>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/nff/nff_reader.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

std::string written(const Scene& scene) {
  std::ostringstream stream;
  nff::write_nff(scene, stream);
  return stream.str();
}

/// Everything that NFF must preserve, as words that are equal if the bits are equal. Polygons are
/// represented by the positions of their vertices, because the sharing of vertices is not
/// preserved.
class Contents {
 public:
  explicit Contents(const Scene& scene) : scene_(scene) {
    add(scene.background, scene.bounds.lower, scene.bounds.upper);
    add(scene.cameras.size(), scene.lights.size(), scene.primitives.size());
    for (const Camera& camera : scene.cameras) {
      add(camera.from, camera.at, camera.up, camera.angle, camera.aspect, camera.hither);
      add(camera.width, camera.height, camera.name.size());
      for (const char c : camera.name) add(c);
    }
    for (const Light& light : scene.lights) add(light.position, light.color);
    for (const Surface& s : scene.surfaces) {
      add(s.color, s.diffuse, s.specular, s.shine, s.transmittance, s.refraction_index);
      add(static_cast<int>(s.finish));
    }
    for (const Primitive& primitive : scene.primitives) add_primitive(primitive);
  }

  bool operator==(const Contents& other) const { return words_ == other.words_; }

 private:
  void add_primitive(const Primitive& primitive) {
    add(static_cast<int>(primitive.kind), primitive.index, primitive.surface);
    switch (primitive.kind) {
      case PrimitiveKind::kSphere: {
        const Sphere& sphere = scene_.spheres[primitive.index];
        return add(sphere.center, sphere.radius, sphere.inside_only);
      }
      case PrimitiveKind::kCone: {
        const Cone& cone = scene_.cones[primitive.index];
        return add(cone.base, cone.base_radius, cone.apex, cone.apex_radius, cone.inside_only);
      }
      case PrimitiveKind::kPolygon:
        return add_polygon(scene_.polygons[primitive.index]);
    }
  }

  void add_polygon(const Polygon& polygon) {
    const bool smooth = polygon.first_normal != Polygon::kFlat;
    add(polygon.corner_count, polygon.triangle_count, smooth);
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      add(scene_.vertices[scene_.corners[polygon.first_corner + i]]);
      if (smooth) add(scene_.normals[polygon.first_normal + i]);
    }
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      const Triangle& triangle = scene_.triangles[polygon.first_triangle + i];
      add(triangle.primitive);
      for (const std::uint32_t vertex : triangle.vertex) add(scene_.vertices[vertex]);
    }
  }

  template <typename... Values>
  void add(const Values&... values) {
    (put(values), ...);
  }
  template <typename Integer>
  void put(Integer number) {
    words_.push_back(static_cast<std::uint32_t>(number));
  }
  void put(float number) { words_.push_back(std::bit_cast<std::uint32_t>(number)); }
  void put(const glm::vec3& point) { add(point.x, point.y, point.z); }

  const Scene& scene_;
  std::vector<std::uint32_t> words_;
};

/// Returns whether the written scene reads back the same, without a warning.
testing::AssertionResult survives(const Scene& scene) {
  const nff::NffResult result = nff::parse_nff(written(scene), "test.nff", {.strict = true});
  if (Contents(result.scene) != Contents(scene)) {
    return testing::AssertionFailure() << scene.name << " reads back changed";
  }
  if (scene_hash(result.scene) != scene_hash(scene)) {
    return testing::AssertionFailure() << scene.name << " reads back with another hash";
  }
  return testing::AssertionSuccess();
}

TEST(NffWriter, AllScenesOfTheCatalogueReadBackTheSame) {
  for (const SceneInfo& info : scene_catalogue()) EXPECT_TRUE(survives(load_scene(info.name)));
}

TEST(NffWriter, FilesReadBackTheSame) {
  const std::string folder = std::string(BEAMBENCH_TEST_FILES) + "/golden/nff/";
  for (const char* name : {"complete.nff", "quirks.nff", "thesis.nff"}) {
    EXPECT_TRUE(survives(nff::read_nff(folder + name).scene));
  }
}

TEST(NffWriter, AnEmptySceneReadsBackTheSame) { EXPECT_TRUE(survives(SceneBuilder("").build())); }

TEST(NffWriter, ANameCannotLeaveItsComment) {
  SceneBuilder builder("two\nlines\r");
  builder.add_sphere({0, 0, 0}, 1.0);
  EXPECT_TRUE(survives(std::move(builder).build()));
}

/// Draws numbers of all sizes that a scene may hold; some of them are special values.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t count) { return random_.below(count); }
  float any() {
    static constexpr std::array<float, 8> kSpecial = {0.0F,   -0.0F, 1e9F,        -1e9F,
                                                      1e-45F, 0.1F,  16777216.0F, 0x1.5c87fap-84F};
    if (below(4) == 0) return kSpecial[below(kSpecial.size())];
    while (true) {
      const auto number = std::bit_cast<float>(static_cast<std::uint32_t>(random_.bits()));
      if (std::abs(number) <= 1e9F) return number;
    }
  }
  float between(double low, double high) { return static_cast<float>(random_.uniform(low, high)); }
  glm::vec3 point() {
    const float x = any();
    const float y = any();
    return {x, y, any()};
  }

 private:
  Random random_;
};

Camera random_camera(Numbers& numbers) {
  static const std::array<const char*, 5> kNames = {"default", "a b", "name", "view 7", "Eñe: 1/2"};
  Camera camera;
  camera.name = kNames[numbers.below(kNames.size())];
  camera.from = numbers.point();
  camera.at = numbers.point();
  camera.up = numbers.point();
  camera.angle = numbers.between(1e-3, 179.9);
  camera.aspect = numbers.between(1e-3, 1e3);
  camera.hither = numbers.any();
  camera.width = static_cast<int>(1 + numbers.below(65535));
  camera.height = static_cast<int>(1 + numbers.below(65535));
  return camera;
}

Surface random_surface(Numbers& numbers) {
  const auto finish = static_cast<Finish>(numbers.below(13));
  if (numbers.below(2) == 0) return finished_surface(finish);
  return {numbers.point(), numbers.any(), numbers.any(), numbers.any(),
          numbers.any(),   numbers.any(), finish};
}

void add_polygon(SceneBuilder& builder, Numbers& numbers) {
  std::vector<glm::dvec3> corners;
  std::vector<glm::dvec3> normals;
  const std::uint64_t count = 3 + numbers.below(4);
  const bool smooth = numbers.below(2) == 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const bool repeated = i > 0 && numbers.below(8) == 0;
    corners.push_back(repeated ? corners.back() : glm::dvec3(numbers.point()));
    if (smooth) normals.emplace_back(numbers.below(8) == 0 ? glm::vec3(0.0F) : numbers.point());
  }
  builder.add_polygon(corners, normals);
}

void add_something(SceneBuilder& builder, Numbers& numbers) {
  const double sign = numbers.below(2) == 0 ? 1.0 : -1.0;
  switch (numbers.below(7)) {
    case 0:
      return builder.add_camera(random_camera(numbers));
    case 1:
      return builder.add_light(numbers.point(), numbers.point());
    case 2:
      return builder.set_background(numbers.point());
    case 3:
      return builder.set_surface(random_surface(numbers));
    case 4:
      return builder.add_sphere(numbers.point(), numbers.any());
    case 5:
      return builder.add_cone(numbers.point(), sign * std::abs(numbers.any()), numbers.point(),
                              sign * std::abs(numbers.any()));
    default:
      return add_polygon(builder, numbers);
  }
}

RC_GTEST_PROP(NffWriter, AnySceneReadsBackTheSame, (std::uint64_t seed)) {
  Numbers numbers(seed);
  SceneBuilder builder("random");
  const std::uint64_t things = numbers.below(60);
  for (std::uint64_t i = 0; i < things; ++i) {
    try {
      add_something(builder, numbers);
    } catch (const InputError&) {
      // The builder refuses numbers that do not form a camera or primitive; skip them here as well.
    }
  }
  std::optional<Scene> built;
  try {
    built = std::move(builder).build();
  } catch (const InputError&) {
    RC_DISCARD("the builder refuses a scene that is too small for single precision");
  }
  const Scene& scene = *built;
  RC_ASSERT(survives(scene));
  // The scene is read under its own name, so even the comment is the same when it is written again.
  const Scene again = nff::parse_nff(written(scene), "random").scene;
  RC_ASSERT(written(again) == written(scene));
}

TEST(NffWriter, WritesWhatOtherProgramsRead) {
  SceneBuilder builder("one of everything");
  Camera camera;
  camera.name = "side";
  camera.aspect = 1.5F;
  builder.add_camera(camera);
  builder.add_light({1, 2, 0.1}, {20, 0, 1});
  builder.set_surface({.color = {1, 0, 0}, .shine = 100000.0F});
  builder.add_sphere({1e-5, 0, -3}, -0.25);
  builder.add_cone({0, 0, 0}, 0, {0, 0, 1}, -2);
  builder.set_surface(finished_surface(Finish::kRedMarble));
  builder.add_polygon(std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  builder.set_surface({.color = {0, 1, 0}, .finish = Finish::kGlass});
  builder.add_polygon(std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                      std::vector<glm::dvec3>(3, glm::dvec3(0, 0, 1)));
  EXPECT_EQ(written(std::move(builder).build()),
            "# one of everything\n"
            "b 0 0 0\n"
            "v\nfrom 0 0 0\nat 0 0 -1\nup 0 1 0\nangle 45\nhither 0\nresolution 512 512\n"
            "#beambench name side\n#beambench aspect 1.5\n"
            "l 1 2 0.1 20 0 1\n"
            "f 1 0 0 1 0 100000 0 1\n"
            "s 1e-05 0 -3 -0.25\n"
            "c\n0 0 0 0\n0 0 1 -2\n"
            "texredmarble\n"
            "p 3\n0 0 0\n1 0 0\n0 1 0\n"
            "surfglass 0 1 0 1 0 0 0 1\n"
            "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n");
}

TEST(NffWriter, ReportsAFailingStream) {
  std::ostringstream stream;
  stream.setstate(std::ios::badbit);
  nff::write_nff(SceneBuilder("test").build(), stream);
  EXPECT_TRUE(stream.bad());
}

}  // namespace
}  // namespace beambench::scenes
