#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "scenes/animation.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "tests/scenes/gltf_files.hpp"
#include "tests/scenes/put.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

using Json = nlohmann::json;

constexpr float kHalf = 0.70710678F;  // the sine and cosine of 45 degrees

int add_floats(GltfFile& file, const std::vector<float>& numbers, std::size_t each,
               const char* shape) {
  std::string bytes;
  for (const float number : numbers) tests::put(bytes, number);
  return file.add_accessor(file.add_view(bytes), GltfType::kFloat, numbers.size() / each, shape);
}

/// Returns how many numbers a value of the path has.
std::size_t size_of(const std::string& path) { return path == "rotation" ? 4 : 3; }

/// Adds a channel to the file's only animation.
void add_channel(GltfFile& file, int node, const std::string& path, const std::vector<float>& times,
                 const std::vector<float>& values, const char* interpolation = "LINEAR") {
  Json& animation = file.json["animations"][0];
  const int input = add_floats(file, times, 1, "SCALAR");
  const int output = add_floats(file, values, size_of(path), path == "rotation" ? "VEC4" : "VEC3");
  const std::size_t sampler = animation["samplers"].size();
  animation["samplers"].push_back(
      {{"input", input}, {"output", output}, {"interpolation", interpolation}});
  animation["channels"].push_back(
      {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
}

class GltfAnimations : public testing::Test {
 protected:
  GltfAnimations() { ::setenv("BEAMBENCH_CACHE", (folder_.path() / "cache").c_str(), 1); }
  ~GltfAnimations() override { ::unsetenv("BEAMBENCH_CACHE"); }

  void SetUp() override {
    if (mesh::importer_of("gltf").empty()) GTEST_SKIP() << "built without tinygltf";
  }

  Animation load(const GltfFile& file) {
    warnings_.clear();
    return load_animation(folder_.write("a.glb", glb(file)).string(), &warnings_);
  }
  std::string message(const GltfFile& file) {
    return thrown_message([&] { load(file); });
  }
  /// Returns the file's corners in a frame.
  std::vector<glm::vec3> corners(const GltfFile& file, std::uint32_t frame) {
    Animation animation = load(file);
    show_frame(animation, frame);
    std::vector<glm::vec3> places;
    for (const std::uint32_t corner : animation.scene.corners) {
      places.push_back(animation.scene.vertices[corner]);
    }
    return places;
  }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

void expect_near(const glm::vec3& place, const glm::vec3& expected) {
  EXPECT_LT(glm::distance(place, expected), 1e-6F)
      << place.x << ' ' << place.y << ' ' << place.z << ", not " << expected.x << ' ' << expected.y
      << ' ' << expected.z;
}

TEST_F(GltfAnimations, ANodeMovesAndTurnsAtTwentyFourFramesPerSecond) {
  GltfFile file = gltf_triangle();
  add_channel(file, 0, "translation", {0.0F, 1.0F}, {0, 0, 0, 6, 0, 3});
  add_channel(file, 0, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, 1, 0});  // 180 degrees about z
  const Animation animation = load(file);
  EXPECT_EQ(animation.frames, 25U);
  EXPECT_TRUE(warnings_.empty());
  const auto first = corners(file, 0);
  EXPECT_EQ(first, animation.scene.vertices);
  expect_near(first[1], {1, 0, 0});
  const auto middle = corners(file, 12);
  expect_near(middle[0], {3, 0, 1.5F});
  expect_near(middle[1], {3, 1, 1.5F});
  expect_near(middle[2], {2, 0, 1.5F});
  const auto third = corners(file, 8);  // 60 degrees
  expect_near(third[1], {2 + 0.5F, std::sqrt(0.75F), 1});
  const auto last = corners(file, 24);
  expect_near(last[1], {5, 0, 3});
  EXPECT_EQ(corners(file, 12), middle) << "the same from the cache";
}

TEST_F(GltfAnimations, ChildrenMoveWithTheirParentAndOthersStay) {
  GltfFile file = gltf_triangle();
  file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 5}}});
  file.json["nodes"][0] = {{"children", {1}}};
  file.add_node({{"mesh", 0}});
  add_channel(file, 0, "scale", {0.0F, 0.5F}, {1, 1, 1, 3, 3, 3});
  const auto middle = corners(file, 6);
  ASSERT_EQ(middle.size(), 6U);
  expect_near(middle[0], {0, 0, 10});
  expect_near(middle[1], {2, 0, 10});
  expect_near(middle[4], {1, 0, 0});
}

TEST_F(GltfAnimations, VerticesThatSeparateAreNotMerged) {
  GltfFile file = gltf_triangle();
  file.add_node({{"mesh", 0}, {"scale", {-1, 1, 1}}});  // shares an edge with the first
  add_channel(file, 1, "translation", {0.0F, 1.0F}, {0, 0, 0, -4, 0, 0});
  const auto last = corners(file, 24);
  expect_near(last[0], {0, 0, 0});
  expect_near(last[2], {0, 1, 0});
  expect_near(last[3], {-4, 0, 0});
  expect_near(last[5], {-4, 1, 0});
}

TEST_F(GltfAnimations, StepsHoldAndSplinesFollowTheirTangents) {
  GltfFile step = gltf_triangle();
  add_channel(step, 0, "translation", {0.0F, 0.5F, 1.0F}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "STEP");
  expect_near(corners(step, 11)[0], {0, 0, 0});
  expect_near(corners(step, 12)[0], {1, 0, 0});
  expect_near(corners(step, 24)[0], {2, 0, 0});

  // From 0 to 1 in 2 s, starting at 1 per second and arriving at 0 per second. In the middle,
  // h01 = 1/2, and h10 = 1/8, which is multiplied by the 2 s.
  GltfFile spline = gltf_triangle();
  add_channel(spline, 0, "translation", {0.0F, 2.0F},
              {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 9, 9, 9}, "CUBICSPLINE");
  expect_near(corners(spline, 0)[0], {0, 0, 0});
  expect_near(corners(spline, 24)[0], {0.75F, 0, 0});
  expect_near(corners(spline, 48)[0], {1, 0, 0});

  GltfFile turn = gltf_triangle();
  add_channel(turn, 0, "rotation", {0.0F, 1.0F},
              {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0},
              "CUBICSPLINE");
  expect_near(corners(turn, 12)[1], {0, 1, 0});
}

TEST_F(GltfAnimations, RotationsTakeTheShorterWay) {
  GltfFile file = gltf_triangle();  // turns to 90 degrees about z, given as a negated quaternion
  add_channel(file, 0, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, -kHalf, -kHalf});
  const float part = static_cast<float>(std::numbers::pi) / 4.0F;
  expect_near(corners(file, 12)[1], {std::cos(part), std::sin(part), 0});
}

TEST_F(GltfAnimations, FramesBeforeTheFirstTimeShowItsValue) {
  GltfFile file = gltf_triangle();
  add_channel(file, 0, "translation", {0.5F, 1.0F}, {7, 0, 0, 9, 0, 0});
  expect_near(corners(file, 0)[0], {7, 0, 0});
  expect_near(corners(file, 12)[0], {7, 0, 0});
  expect_near(corners(file, 18)[0], {8, 0, 0});
}

TEST_F(GltfAnimations, LongOnesHaveAThousandFrames) {
  GltfFile file = gltf_triangle();
  add_channel(file, 0, "translation", {0.0F, 999.0F}, {0, 0, 0, 999, 0, 0});
  const Animation animation = load(file);
  EXPECT_EQ(animation.frames, 1000U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(says(warnings_[0], {"999 s", "1000 frames", "instead of 23977"}));
  expect_near(corners(file, 400)[0], {400, 0, 0});
}

/// Returns two triangles, each moved by one joint, and a shared corner moved by both.
GltfFile with_skin() {
  GltfFile file;
  const int positions = file.add_positions({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {1, 2, 0}});
  const int indices = file.add_indices({0, 1, 2, 1, 3, 2}, GltfType::kUByte);
  const int mesh = file.add_mesh(positions, indices);
  std::string joints;
  for (const int joint : {0, 0, 1, 1}) {
    for (const int number : {joint, 1 - joint, 0, 0}) {
      joints += static_cast<char>(number);
    }
  }
  Json& attributes = file.json["meshes"][mesh]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = file.add_accessor(file.add_view(joints), GltfType::kUByte, 4, "VEC4");
  attributes["WEIGHTS_0"] =
      add_floats(file, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0}, 4, "VEC4");
  file.add_node({{"mesh", mesh}, {"skin", 0}, {"translation", {50, 50, 50}}});  // ignored
  file.add_node({{"children", {2}}});
  file.json["nodes"].push_back({{"translation", {0, 1, 0}}});
  const int inverse = add_floats(file, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                 16, "MAT4");
  file.json["skins"] = Json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}});
  return file;
}

TEST_F(GltfAnimations, ASkinWithoutAnimationIsInItsPose) {
  GltfFile file = with_skin();
  expect_near(corners(file, 0)[2], {0, 2, 0});
  file.json["nodes"][2]["translation"] = {0, 1, 3};
  const auto places = corners(file, 0);
  expect_near(places[0], {0, 0, 0});
  expect_near(places[2], {0, 2, 3});
  expect_near(places[4], {1, 2, 1.5F});
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(GltfAnimations, JointsMoveAndBlendTheVertices) {
  GltfFile file = with_skin();
  // The upper joint, at (0, 1, 0), turns by 90 degrees about z: (0, 2, 0) goes to (-1, 1, 0).
  add_channel(file, 2, "rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, kHalf, kHalf});
  const auto last = corners(file, 24);
  expect_near(last[0], {0, 0, 0});
  expect_near(last[1], {1, 0, 0});
  expect_near(last[2], {-1, 1, 0});
  expect_near(last[4], {0, 2, 0});  // half of (1, 2, 0), half of (-1, 2, 0)
}

TEST_F(GltfAnimations, OmittedPartsAreReported) {
  GltfFile file = gltf_triangle();
  const int offsets = file.add_positions({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  file.json["meshes"][0]["primitives"][0]["targets"] = Json::array({{{"POSITION", offsets}}});
  add_channel(file, 0, "translation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0});
  const int weights = add_floats(file, {0, 1}, 1, "SCALAR");
  Json& animation = file.json["animations"][0];
  animation["samplers"].push_back({{"input", weights}, {"output", weights}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}});
  file.json["animations"].push_back(animation);
  EXPECT_EQ(load(file).frames, 25U);
  ASSERT_EQ(warnings_.size(), 3U);
  EXPECT_TRUE(says(warnings_[0], {"1 nodes have morph targets, which were left out"}));
  EXPECT_TRUE(says(warnings_[1], {"1 animations after the first were left out"}));
  EXPECT_TRUE(says(warnings_[2], {"1 channels of its animation were left out"}));
}

TEST_F(GltfAnimations, OneOfOnlyACameraMovesNothing) {
  GltfFile file = gltf_triangle();
  file.add_node({{"name", "empty"}});
  add_channel(file, 1, "translation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0});
  EXPECT_EQ(load(file).frames, 1U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_TRUE(says(warnings_[0], {"its animation moves no triangles"}));
}

TEST_F(GltfAnimations, ARefusalNamesTheChannelOrSampler) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto refusal = [&](const std::vector<float>& times, const std::vector<float>& values,
                           const char* interpolation = "LINEAR") {
    GltfFile file = gltf_triangle();
    add_channel(file, 0, "translation", times, values, interpolation);
    return message(file);
  };
  EXPECT_TRUE(says(refusal({0, kNan}, {0, 0, 0, 1, 0, 0}),
                   {"a.glb", "sampler 0 of animation 0: time 1 is nan"}));
  EXPECT_TRUE(says(refusal({1, 1}, {0, 0, 0, 1, 0, 0}), {"time 1 is 1; times must be"}));
  EXPECT_TRUE(says(refusal({-1, 1}, {0, 0, 0, 1, 0, 0}), {"time 0 is -1"}));
  EXPECT_TRUE(says(refusal({0, 1}, {0, 0, 0, kNan, 0, 0}), {"sampler 0", "value 1 is not finite"}));
  EXPECT_TRUE(says(refusal({0, 1}, {0, 0, 0}), {"sampler 0", "1 values, but its times need 2"}));
  EXPECT_TRUE(says(refusal({0, 1}, {0, 0, 0, 1, 0, 0}, "CUBICSPLINE"), {"need 6"}));
  EXPECT_TRUE(says(refusal({0, 1}, {0, 0, 0, 1, 0, 0}, "WAVY"),
                   {"sampler 0 of animation 0 has an unknown interpolation"}));

  const auto changed = [&](const char* path, const Json& value) {
    GltfFile file = gltf_triangle();
    add_channel(file, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
    file.json["animations"][0][Json::json_pointer(path)] = value;
    return message(file);
  };
  EXPECT_TRUE(
      says(changed("/samplers/0/input", 77), {"sampler 0 of animation 0 refers to accessor 77"}));
  EXPECT_TRUE(says(changed("/samplers/0/output", 1),
                   {"accessor 1 of sampler 0 of animation 0 does not have the required type"}));
  EXPECT_TRUE(
      says(changed("/channels/0/sampler", 3), {"channel 0 of animation 0 refers to sampler 3"}));
  EXPECT_TRUE(
      says(changed("/channels/0/target/node", 9), {"channel 0 of animation 0 refers to node 9"}));

  GltfFile twice = gltf_triangle();
  add_channel(twice, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  add_channel(twice, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  EXPECT_TRUE(says(message(twice), {"channel 1 of animation 0 is for the translation of node 0"}));
  GltfFile fixed = gltf_triangle();
  fixed.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  add_channel(fixed, 0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
  EXPECT_TRUE(says(message(fixed), {"channel 0", "node 0, which has a matrix"}));
}

TEST_F(GltfAnimations, ARefusalNamesTheSkin) {
  const auto changed = [&](const char* path, const Json& value) {
    GltfFile file = with_skin();
    file.json[Json::json_pointer(path)] = value;
    return message(file);
  };
  EXPECT_TRUE(says(changed("/skins/0/joints", {1, 9}), {"skin 0 has the joint node 9"}));
  EXPECT_TRUE(says(changed("/skins/0/joints", {1, 2, 0}),
                   {"skin 0 has 3 joints, but 2 inverse bind matrices"}));
  EXPECT_TRUE(says(changed("/skins/0/joints", {1}), {"has the joint 1, but there are 1"}));
  EXPECT_TRUE(says(changed("/skins/0/inverseBindMatrices", 0), {"accessor 0 of skin 0"}));
  EXPECT_TRUE(says(changed("/nodes/0/skin", 4), {"a node refers to skin 4"}));
  GltfFile bare = with_skin();
  bare.json["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
  EXPECT_TRUE(says(message(bare), {"JOINTS_0 and WEIGHTS_0"}));
}

TEST_F(GltfAnimations, AFrameBeyondTheLimitIsRefusedWithItsNumber) {
  GltfFile file = gltf_triangle();
  add_channel(file, 0, "translation", {0.0F, 1.0F}, {0, 0, 0, 2.4e9F, 0, 0});
  Animation animation = load(file);
  show_frame(animation, 9);
  EXPECT_TRUE(says(thrown_message([&] { show_frame(animation, 11); }),
                   {"a.glb: frame 11: primitive 0: a corner is (1100000000, 0, 0)"}));
}

}  // namespace
}  // namespace beambench::scenes
