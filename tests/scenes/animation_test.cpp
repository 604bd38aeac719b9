#include "scenes/animation.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {
namespace {

std::vector<std::string> moving_scenes() {
  std::vector<std::string> names;
  for (const SceneInfo& info : scene_catalogue()) {
    if (info.animate) names.push_back(info.name);
  }
  return names;
}

class Moving : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Catalogue, Moving, testing::ValuesIn(moving_scenes()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Animation, TheCatalogueHasFiveScenesThatMove) {
  EXPECT_EQ(moving_scenes(),
            (std::vector<std::string>{"exploding-mesh", "falling-spheres", "turning-solids",
                                      "twisting-body", "waving-sheet"}));
}

TEST_P(Moving, FrameZeroIsTheScene) {
  Animation animation = load_animation(GetParam());
  const SceneInfo& info = find_scene(GetParam());
  const Scene generated = info.generate(Parameters(info.name, info.parameters, {}));
  EXPECT_EQ(animation.frames, 20U);
  EXPECT_EQ(scene_hash(animation.scene), scene_hash(generated));
  const Pose first = animation.pose(0);
  EXPECT_EQ(first.vertices, generated.vertices);
  EXPECT_EQ(first.normals, generated.normals);
  show_frame(animation, 0);
  EXPECT_EQ(scene_hash(animation.scene), scene_hash(generated));
  EXPECT_EQ(animation.scene.bounds.lower, generated.bounds.lower);
  EXPECT_EQ(animation.scene.bounds.upper, generated.bounds.upper);
}

TEST_P(Moving, EveryFrameIsAnotherPlaceOfTheSamePrimitives) {
  const Scene first = load_scene(GetParam());
  Animation animation = load_animation(GetParam());
  std::uint64_t before = scene_hash(first);
  for (std::uint32_t frame = 1; frame < animation.frames; ++frame) {
    show_frame(animation, frame);
    const std::uint64_t hash = scene_hash(animation.scene);
    EXPECT_NE(hash, before) << frame;
    before = hash;
  }
  const Scene& last = animation.scene;
  EXPECT_EQ(last.corners, first.corners);
  ASSERT_EQ(last.primitives.size(), first.primitives.size());
  for (std::size_t i = 0; i < first.primitives.size(); ++i) {
    ASSERT_EQ(last.primitives[i].index, first.primitives[i].index);
    ASSERT_EQ(last.primitives[i].surface, first.primitives[i].surface);
  }
  for (std::size_t i = 0; i < first.triangles.size(); ++i) {
    ASSERT_EQ(last.triangles[i].vertex, first.triangles[i].vertex);
  }
  for (const glm::vec3& normal : last.normals) ASSERT_NEAR(glm::length(normal), 1.0F, 1e-5F);
}

TEST_P(Moving, AFrameDoesNotDependOnThoseShownBefore) {
  Animation there = load_animation(GetParam());
  Animation back = load_animation(GetParam());
  for (const std::uint32_t frame : {0U, 4U, 19U, 11U}) show_frame(back, frame);
  for (const std::uint32_t frame : {11U, 19U, 4U, 0U}) {
    show_frame(back, frame);
    show_frame(there, frame);
    EXPECT_EQ(scene_hash(back.scene), scene_hash(there.scene)) << frame;
    there = load_animation(GetParam());
  }
}

TEST_P(Moving, HashesOfFramesArePinned) {
  const std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> hashes = {
      {"exploding-mesh", {0xeebc27e244545d78, 0x78fddd30e75813af}},
      {"falling-spheres", {0x2a263f4fb740dec2, 0x8bcc4c64f3f3f908}},
      {"turning-solids", {0x5815a2bcef3dbf7a, 0x9040434c6b4403bb}},
      {"twisting-body", {0x67a530b604ff85c3, 0xca9a71a870ead01d}},
      {"waving-sheet", {0xecd6cd5211aa8388, 0xcf7afccbd1252c7a}},
  };
  Animation animation = load_animation(GetParam());
  show_frame(animation, 7);
  const std::uint64_t seventh = scene_hash(animation.scene);
  show_frame(animation, 19);
  EXPECT_EQ(std::pair(seventh, scene_hash(animation.scene)), hashes.at(GetParam()))
      << std::hex << "{\"" << GetParam() << "\", {0x" << seventh << ", 0x"
      << scene_hash(animation.scene) << "}},";
}

TEST_P(Moving, SizesAndFramesAreParameters) {
  const SceneInfo& info = find_scene(GetParam());
  const auto size = std::ranges::find(info.parameters, info.size_parameter, &ParameterInfo::name);
  ASSERT_NE(size, info.parameters.end());
  const auto least = static_cast<std::int64_t>(size->minimum);
  Animation animation =
      load_animation(info.name + ":frames=3," + size->name + "=" + std::to_string(least));
  EXPECT_EQ(animation.frames, 3U);
  show_frame(animation, 2);
  EXPECT_EQ(animation.scene.primitives.size() < load_scene(info.name).primitives.size(), true);
  EXPECT_TRUE(says(thrown_message([&] { load_animation(info.name + ":frames=1"); }), {"frames"}));
}

/// Returns a triangle and a sphere.
Scene two_primitives() {
  SceneBuilder builder("two");
  builder.add_polygon(std::array<glm::dvec3, 3>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  builder.add_sphere({3, 0, 0}, 0.5);
  return std::move(builder).build();
}

TEST(Animation, InvalidCoordinatesAreRefusedWithFrameAndPrimitive) {
  Scene scene = two_primitives();
  const std::uint64_t hash = scene_hash(scene);
  for (const float number :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e9F}) {
    Pose pose = pose_of(scene);
    pose.vertices[1].y = number;
    EXPECT_TRUE(says(thrown_message([&] { set_pose(scene, pose, 6); }),
                     {"two: frame 6: primitive 0: a corner is (1, "}));
    pose = pose_of(scene);
    pose.spheres[0].center.z = number;
    EXPECT_TRUE(says(thrown_message([&] { set_pose(scene, pose, 6); }),
                     {"two: frame 6: primitive 1: its center is (3, 0, "}));
    EXPECT_EQ(scene_hash(scene), hash) << "the scene is unchanged";
  }
}

TEST(Animation, OtherCountsAndRadiiAreRefused) {
  Scene scene = two_primitives();
  Pose pose = pose_of(scene);
  pose.vertices.pop_back();
  EXPECT_TRUE(says(thrown_message([&] { set_pose(scene, pose, 2); }),
                   {"frame 2: 2 vertices, but the scene has 3"}));
  pose = pose_of(scene);
  pose.spheres.clear();
  EXPECT_TRUE(says(thrown_message([&] { set_pose(scene, pose, 2); }), {"0 spheres"}));
  pose = pose_of(scene);
  pose.spheres[0].radius = 2.0F;
  EXPECT_TRUE(says(thrown_message([&] { set_pose(scene, pose, 2); }),
                   {"primitive 1: its radius is 2, but that of the scene is 0.5"}));
}

TEST(Animation, AFrameMayBeDegenerate) {
  Scene scene = two_primitives();
  Pose pose = pose_of(scene);
  std::ranges::fill(pose.vertices, glm::vec3(3.0F, 0.0F, 0.0F));
  set_pose(scene, pose, 1);
  EXPECT_EQ(scene.bounds.lower, glm::vec3(2.5F, -0.5F, -0.5F));
  EXPECT_EQ(scene.bounds.upper, glm::vec3(3.5F, 0.5F, 0.5F));
}

TEST(Animation, AMissingFrameIsRefused) {
  Animation moving = load_animation("falling-spheres:spheres=1,frames=5");
  EXPECT_TRUE(says(thrown_message([&] { show_frame(moving, 5); }),
                   {"falling-spheres", "the animation has frames 0 to 4"}));
  Animation still = load_animation("tetra:n=1");
  EXPECT_EQ(still.frames, 1U);
  show_frame(still, 0);
  EXPECT_TRUE(says(thrown_message([&] { show_frame(still, 1); }), {"the scene does not move"}));
}

TEST(Animation, APerturbedSceneIsStatic) {
  EXPECT_EQ(load_animation("waving-sheet:triangles=200,perturb=1").frames, 1U);
}

}  // namespace
}  // namespace beambench::scenes
