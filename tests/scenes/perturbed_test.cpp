#include "scenes/perturbed.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::scenes {
namespace {

TEST(Perturbed, KeepsPrimitivesAndTheirSurfacesInEveryCatalogueScene) {
  for (const SceneInfo& info : scene_catalogue()) {
    const Scene scene = load_scene(info.name);
    const Scene other = perturbed(scene, 7);
    ASSERT_EQ(other.primitives.size(), scene.primitives.size()) << info.name;
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      ASSERT_EQ(other.primitives[i].kind, scene.primitives[i].kind) << info.name << ' ' << i;
      ASSERT_EQ(other.surfaces[other.primitives[i].surface].color,
                scene.surfaces[scene.primitives[i].surface].color)
          << info.name << ' ' << i;
    }
    EXPECT_EQ(other.lights.size(), scene.lights.size()) << info.name;
    EXPECT_EQ(other.cameras.size(), scene.cameras.size()) << info.name;
    EXPECT_NE(scene_hash(other), scene_hash(scene)) << info.name;
  }
}

TEST(Perturbed, DependsOnlyOnTheSeed) {
  EXPECT_EQ(scene_hash(load_scene("maceta:perturb=3")), scene_hash(load_scene("maceta:perturb=3")));
  EXPECT_NE(scene_hash(load_scene("maceta:perturb=3")), scene_hash(load_scene("maceta:perturb=4")));
  EXPECT_EQ(scene_hash(load_scene("maceta:perturb=0")), scene_hash(load_scene("maceta")));
}

TEST(Perturbed, KeepsTheShapeOfAnObject) {
  const Scene scene = load_scene("delfines");
  const Scene other = perturbed(scene, 5);
  ASSERT_EQ(other.corners.size(), scene.corners.size());
  float moved = 0.0F;
  for (const Polygon& polygon : scene.polygons) {
    for (std::uint32_t i = 0; i + 1 < polygon.corner_count; ++i) {
      const auto corner = [&](const Scene& of, std::uint32_t k) {
        return of.vertices[of.corners[polygon.first_corner + k]];
      };
      EXPECT_NEAR(glm::distance(corner(other, i), corner(other, i + 1)),
                  glm::distance(corner(scene, i), corner(scene, i + 1)), 1e-6F);
      moved = std::max(moved, glm::distance(corner(other, i), corner(scene, i)));
    }
  }
  const float size = glm::length(scene.bounds.extent());
  EXPECT_GT(moved, 0.01F * size);
  EXPECT_LT(moved, 0.2F * size);
}

TEST(Perturbed, LeavesFloorsInPlace) {
  const Scene scene = load_scene("balls:n=2");
  const Scene other = perturbed(scene, 2);
  ASSERT_EQ(other.vertices.size(), scene.vertices.size());
  for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
    EXPECT_EQ(other.vertices[i], scene.vertices[i]);
  }
}

TEST(Perturbed, MovesCamerasOutsideAndTurnsThoseInside) {
  const Scene outside = load_scene("delfines");
  const Scene moved = perturbed(outside, 1);
  EXPECT_NE(moved.cameras.front().from, outside.cameras.front().from);
  EXPECT_EQ(moved.cameras.front().at, outside.cameras.front().at);

  const Scene inside = load_scene("habitacion");
  const Scene turned = perturbed(inside, 1);
  EXPECT_EQ(turned.cameras.front().from, inside.cameras.front().from);
  EXPECT_NE(turned.cameras.front().at, inside.cameras.front().at);
}

TEST(Perturbed, NamesTheSceneSoThatItCanBeReloaded) {
  const Scene scene = load_scene("escena1:perturb=2");
  EXPECT_EQ(scene.name, "escena1:seed=2001,spheres=430,perturb=2");
  EXPECT_EQ(scene_hash(load_scene(scene.name)), scene_hash(scene));
  EXPECT_EQ(load_scene("maceta:perturb=2").name, "maceta:perturb=2");
  EXPECT_EQ(load_scene("maceta:perturb=0").name, "maceta");
}

TEST(Perturbed, RefusesInvalidSeeds) {
  for (const char* spec : {"maceta:perturb=-1", "maceta:perturb=x", "maceta:perturb=1,perturb=2"}) {
    EXPECT_THROW(load_scene(spec), InputError) << spec;
  }
}

}  // namespace
}  // namespace beambench::scenes
