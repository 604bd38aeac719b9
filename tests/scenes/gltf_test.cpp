#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck/gtest.h>
#include <sys/stat.h>

#include "scenes/base/error.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/scene_builder.hpp"
#include "scenes/triangulate.hpp"
#include "tests/scenes/gltf_files.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using mesh::ImportedMesh;
using TriangleCorners = std::array<glm::vec3, 3>;

constexpr int kStrip = 5;
constexpr int kFan = 6;

class Gltf : public testing::Test {
 protected:
  Gltf() { ::setenv("BEAMBENCH_CACHE", (folder_.path() / "cache").c_str(), 1); }
  ~Gltf() override { ::unsetenv("BEAMBENCH_CACHE"); }

  void SetUp() override {
    if (mesh::importer_of("gltf").empty()) GTEST_SKIP() << "built without tinygltf";
  }

  ImportedMesh read(const std::string& bytes, const std::string& ending = "gltf") const {
    return mesh::import_mesh(bytes, ending, folder_.path() / ("a." + ending));
  }
  ImportedMesh read(const GltfFile& file) const { return read(glb(file), "glb"); }
  std::string message(const GltfFile& file) const {
    return thrown_message([&] { read(file); });
  }

  TemporaryFolder folder_;
};

std::vector<TriangleCorners> triangles_of(const ImportedMesh& mesh) {
  std::vector<TriangleCorners> triangles;
  for (const auto& [a, b, c] : mesh.mesh.triangles) {
    triangles.push_back({mesh.mesh.vertices[a], mesh.mesh.vertices[b], mesh.mesh.vertices[c]});
  }
  return triangles;
}

/// Returns the triangles of lists, strips and fans according to glTF 2.0, 3.7.2.1.
std::vector<TriangleCorners> triangles_by_the_book(const std::vector<glm::vec3>& p, int mode) {
  std::vector<TriangleCorners> triangles;
  if (mode == 4) {
    for (std::size_t i = 0; i + 2 < p.size(); i += 3)
      triangles.push_back({p[i], p[i + 1], p[i + 2]});
  }
  for (std::size_t i = 0; mode == kStrip && i + 2 < p.size(); ++i) {
    triangles.push_back({p[i], p[i + 1 + i % 2], p[i + 2 - i % 2]});
  }
  for (std::size_t i = 0; mode == kFan && i + 2 < p.size(); ++i) {
    triangles.push_back({p[i + 1], p[i + 2], p[0]});
  }
  std::erase_if(triangles, [](const TriangleCorners& t) { return !has_area(t[0], t[1], t[2]); });
  return triangles;
}

std::vector<glm::vec3> drawn_positions(int count) {
  const auto number =
      rc::gen::map(rc::gen::inRange(-50, 50), [](int i) { return 0.1F * static_cast<float>(i); });
  std::vector<glm::vec3> positions;
  for (int i = 0; i < count; ++i) positions.emplace_back(*number, *number, *number);
  return positions;
}

RC_GTEST_FIXTURE_PROP(Gltf, ListsStripsAndFansOfAllIndexTypesAreTheirTriangles, ()) {
  const auto positions = drawn_positions(*rc::gen::inRange(3, 12));
  const int mode = *rc::gen::element(4, kStrip, kFan);
  const auto type = *rc::gen::element(GltfType::kUByte, GltfType::kUShort, GltfType::kUInt);
  const bool indexed = *rc::gen::arbitrary<bool>();
  GltfFile file;
  const int accessor = file.add_positions(positions, *rc::gen::element<std::size_t>(0, 12, 16, 40));
  std::vector<glm::vec3> corners = positions;
  int indices = -1;
  if (indexed) {
    std::vector<std::uint32_t> list;
    corners.clear();
    for (int i = 3 * *rc::gen::inRange(1, 8); i > 0; --i) {
      list.push_back(
          static_cast<std::uint32_t>(*rc::gen::inRange<std::size_t>(0, positions.size())));
      corners.push_back(positions[list.back()]);
    }
    indices = file.add_indices(list, type);
  } else if (mode == 4) {
    const std::size_t whole = positions.size() / 3 * 3;
    file.json["accessors"][0]["count"] = whole;
    corners.resize(whole);
  }
  file.add_node({{"mesh", file.add_mesh(accessor, indices, mode)}});
  const auto expected = triangles_by_the_book(corners, mode);
  for (const std::string& bytes : {glb(file), gltf(file)}) {
    if (expected.empty()) {
      RC_ASSERT_THROWS_AS(read(bytes), InputError);
    } else {
      RC_ASSERT(triangles_of(read(bytes)) == expected);
    }
  }
}

TEST_F(Gltf, SparsePositionsReplaceThoseOfTheirBuffer) {
  GltfFile file = gltf_triangle();
  const int indices = file.add_view(std::string("\2", 1));
  const int values = file.add_positions({{0.0F, 7.0F, 0.0F}});
  const Json view = file.json["accessors"][values]["bufferView"];
  file.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", view}}}};
  EXPECT_EQ(read(file).mesh.vertices[2], glm::vec3(0.0F, 7.0F, 0.0F));
  EXPECT_EQ(read(file).mesh.vertices[1], glm::vec3(1.0F, 0.0F, 0.0F));
  file.json["accessors"][0]["sparse"]["count"] = 5;
  EXPECT_TRUE(says(message(file), {"sparse accessor 0", "5 elements"}));
}

TEST_F(Gltf, QuantizedPositionsAreIntegersOrFractions) {
  for (const bool normalized : {false, true}) {
    GltfFile file;
    const std::string bytes("\x00\x00\x00\x00\x7F\x00\x00\x00\x00\x80\x00\x00", 12);
    const int positions = file.add_accessor(file.add_view(bytes, 4), GltfType::kByte, 3, "VEC3");
    file.json["accessors"][positions]["normalized"] = normalized;
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    file.add_node({{"mesh", file.add_mesh(positions, -1)}});
    const ImportedMesh mesh = read(file);
    EXPECT_EQ(mesh.mesh.vertices[1].x, normalized ? 1.0F : 127.0F);
    EXPECT_EQ(mesh.mesh.vertices[2].y, normalized ? -1.0F : -128.0F);
  }
}

// Nodes

glm::dmat4 rotation_about(const glm::dvec3& axis, double degrees) {
  return glm::rotate(glm::dmat4(1.0), glm::radians(degrees), axis);
}

Json rotation_json(const glm::dvec3& axis, double degrees) {
  const double half = glm::radians(0.5 * degrees);
  const glm::dvec3 v = std::sin(half) * axis;
  return {v.x, v.y, v.z, std::cos(half)};
}

RC_GTEST_FIXTURE_PROP(Gltf, NodesPlaceTheirMeshes, ()) {
  const auto number =
      rc::gen::map(rc::gen::inRange(-20, 21), [](int i) { return 0.25 * static_cast<double>(i); });
  const auto size = rc::gen::element(-2.0, 0.5, 1.0, 3.0);  // negative: mirrored
  GltfFile file = gltf_triangle();
  glm::dmat4 matrix(1.0);
  Json nodes = Json::array();
  const int depth = *rc::gen::inRange(1, 5);
  for (int i = 0; i < depth; ++i) {
    const glm::dvec3 move(*number, *number, *number);
    const glm::dvec3 scale(*size, *size, *size);
    const double angle = *rc::gen::inRange(0, 360);
    const glm::dmat4 local = glm::translate(glm::dmat4(1.0), move) *
                             rotation_about({0.0, 0.6, 0.8}, angle) *
                             glm::scale(glm::dmat4(1.0), scale);
    Json node;
    if (*rc::gen::arbitrary<bool>()) {
      for (int j = 0; j < 16; ++j) node["matrix"].push_back(local[j / 4][j % 4]);
    } else {
      node = {{"translation", {move.x, move.y, move.z}},
              {"rotation", rotation_json({0.0, 0.6, 0.8}, angle)},
              {"scale", {scale.x, scale.y, scale.z}}};
    }
    if (i + 1 < depth) node["children"] = {i + 1};
    if (i + 1 == depth) node["mesh"] = 0;
    nodes.push_back(node);
    matrix = matrix * local;
  }
  file.json["nodes"] = nodes;
  const ImportedMesh mesh = read(file);
  const std::array<glm::dvec4, 3> corners{{{0, 0, 0, 1}, {1, 0, 0, 1}, {0, 1, 0, 1}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 expected(matrix * corners[i]);
    RC_ASSERT(glm::distance(glm::dvec3(mesh.mesh.vertices[i]), expected) <
              1e-6 * (1.0 + glm::length(expected)));
  }
}

TEST_F(Gltf, AMeshOfTwoNodesOccursTwice) {
  GltfFile file = gltf_triangle();
  file.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
  const ImportedMesh mesh = read(file);
  ASSERT_EQ(mesh.mesh.triangles.size(), 2U);
  EXPECT_EQ(triangles_of(mesh)[1][0], glm::vec3(5.0F, 0.0F, 0.0F));
}

TEST_F(Gltf, TheDefaultSceneIsRead) {
  GltfFile file = gltf_triangle();
  file.json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  file.json["scenes"].push_back({{"nodes", {1}}});
  EXPECT_EQ(triangles_of(read(file))[0][0].x, 0.0F);
  file.json["scene"] = 1;
  EXPECT_EQ(triangles_of(read(file))[0][0].x, 5.0F);
  file.json.erase("scene");
  EXPECT_EQ(read(file).mesh.triangles.size(), 1U) << "the first scene, because no default is named";
  file.json.erase("scenes");
  EXPECT_EQ(read(file).mesh.triangles.size(), 2U) << "all nodes, because there is no scene";
  file.json["scenes"] = Json::array({{{"nodes", {0}}}});
  file.json["scene"] = 9;
  EXPECT_TRUE(says(message(file), {"the file refers to scene 9", "has only 1"}));
}

TEST_F(Gltf, NodesMayBeNestedDeeplyButNotInACircle) {
  GltfFile file = gltf_triangle();
  constexpr int kDepth = 20000;
  for (int i = 1; i <= kDepth; ++i) {
    file.json["nodes"][i - 1] = {{"children", {i}}, {"translation", {1, 0, 0}}};
  }
  file.json["nodes"][kDepth] = {{"mesh", 0}};
  EXPECT_EQ(triangles_of(read(file))[0][0].x, static_cast<float>(kDepth));
  file.json["nodes"][kDepth]["children"] = {7};
  EXPECT_TRUE(says(message(file), {"node 7 is in its scene twice"}));
}

// Cameras and lights

GltfFile with_camera(const Json& node, const Json& lens) {
  GltfFile file = gltf_triangle();
  file.json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", lens}}});
  file.add_node(node);
  return file;
}

TEST_F(Gltf, CamerasAreThoseOfTheScene) {
  // Turned by 90 degrees about y, a camera that looked at -z looks at -x.
  const GltfFile file = with_camera({{"name", " my #eye "},
                                     {"camera", 0},
                                     {"translation", {4, 0.5, 0.25}},
                                     {"rotation", rotation_json({0.0, 1.0, 0.0}, 90.0)}},
                                    {{"yfov", 0.5}, {"aspectRatio", 2.0}, {"znear", 0.1}});
  const ImportedMesh mesh = read(file);
  ASSERT_EQ(mesh.cameras.size(), 1U);
  const Camera& camera = mesh.cameras[0];
  EXPECT_EQ(camera.name, "my _eye");
  EXPECT_EQ(camera.from, glm::vec3(4.0F, 0.5F, 0.25F));
  EXPECT_NEAR(camera.at.x, 0.5, 1e-5) << "as far as the triangle";
  EXPECT_NEAR(camera.at.y, 0.5, 1e-5);
  EXPECT_NEAR(camera.at.z, 0.25, 1e-5);
  EXPECT_NEAR(camera.up.y, 1.0, 1e-6);
  EXPECT_FLOAT_EQ(camera.angle, static_cast<float>(glm::degrees(0.5)));
  EXPECT_EQ(camera.aspect, 2.0F);
  EXPECT_EQ(camera.width, 1024);

  const Scene scene = load_scene(folder_.write("a.glb", glb(file)).string());
  EXPECT_EQ(scene.cameras.front().name, "my _eye") << "the first is the default";
  EXPECT_EQ(find_camera(scene, "front").name, "front") << "fitted cameras remain";
  EXPECT_EQ(scene.lights.size(), 2U) << "a file without lights gets the default lights";
}

TEST_F(Gltf, NamesOfCamerasAreDistinct) {
  GltfFile file = with_camera({{"name", "eye"}, {"camera", 0}}, {{"yfov", 0.5}, {"znear", 0.1}});
  for (const char* name : {"eye", "front", "eye", "", "\n", "eye 2"}) {
    file.add_node({{"name", name}, {"camera", 0}});
  }
  std::vector<std::string> names;
  for (const Camera& camera : read(file).cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"eye", "eye 2", "front 2", "eye 3", "camera", "_",
                                             "eye 2 2"}));
}

TEST_F(Gltf, CamerasThatASceneCannotHoldAreLeftOut) {
  GltfFile file = with_camera({{"name", "wide"}, {"camera", 0}}, {{"yfov", 3.2}, {"znear", 0.1}});
  file.json["cameras"].push_back(
      {{"type", "orthographic"},
       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}});
  file.add_node({{"name", "flat"}, {"camera", 1}});
  file.json["cameras"].push_back(file.json["cameras"][0]);
  file.json["cameras"][2]["perspective"]["yfov"] = 0.5;
  file.add_node({{"name", "nowhere"}, {"camera", 2}, {"scale", {0, 0, 0}}});
  file.add_node({{"name", "beyond"}, {"camera", 2}, {"translation", {1e12, 0, 0}}});
  const ImportedMesh mesh = read(file);
  EXPECT_TRUE(mesh.cameras.empty());
  ASSERT_EQ(mesh.warnings.size(), 4U);
  EXPECT_TRUE(says(mesh.warnings[0], {"'wide' was left out", "the angle is 183.3"}));
  EXPECT_TRUE(says(mesh.warnings[1], {"'flat' was left out", "not perspective"}));
  EXPECT_TRUE(says(mesh.warnings[2], {"'nowhere' was left out"}));
  EXPECT_TRUE(says(mesh.warnings[3], {"'beyond' was left out", "1e9"}));
}

GltfFile with_lights(const Json& lights) {
  GltfFile file = gltf_triangle();
  file.json["extensionsRequired"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = lights;
  return file;
}

void add_light(GltfFile& file, int light, const Json& place) {
  Json node = place;
  node["extensions"]["KHR_lights_punctual"]["light"] = light;
  file.add_node(node);
}

TEST_F(Gltf, LightsAreAsBrightAsAtTheCenterOfTheScene) {
  GltfFile file = with_lights({{{"type", "point"}, {"intensity", 100}, {"color", {1, 0.5, 0}}},
                               {{"type", "spot"}, {"spot", Json::object()}, {"intensity", 400}},
                               {{"type", "directional"}, {"intensity", 4}}});
  add_light(file, 0, {{"translation", {0.5, 0.5, 5}}});   // 100 / 25 = 4
  add_light(file, 1, {{"translation", {0.5, 0.5, 10}}});  // 400 / 100 = 4
  add_light(file, 2, {{"rotation", rotation_json({0.0, 1.0, 0.0}, 90.0)}});
  const ImportedMesh mesh = read(file);
  ASSERT_EQ(mesh.lights.size(), 3U);
  const auto share = static_cast<float>(1.0 / std::sqrt(3.0));
  EXPECT_NEAR(mesh.lights[0].color.x, share, 1e-6);
  EXPECT_NEAR(mesh.lights[0].color.y, 0.5F * share, 1e-6);
  EXPECT_EQ(mesh.lights[0].color.z, 0.0F);
  EXPECT_NEAR(mesh.lights[1].color.z, share, 1e-6);
  EXPECT_NEAR(mesh.lights[2].color.x, share, 1e-6);
  EXPECT_EQ(mesh.lights[0].position, glm::vec3(0.5F, 0.5F, 5.0F));
  EXPECT_GT(mesh.lights[2].position.x, 500.0F) << "the light travels along -z, turned to -x";
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_TRUE(says(mesh.warnings[0], {"1 spot lights shine in all directions"}));
  EXPECT_EQ(load_scene(folder_.write("a.glb", glb(file)).string()).lights.size(), 3U);
}

// Materials

TEST_F(Gltf, MaterialsBecomeSurfaces) {
  GltfFile file = gltf_triangle();
  file.json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 0.214, 0, 0.25}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
       {"alphaMode", "BLEND"}},
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 1}, {"roughnessFactor", 0}}},
       {"alphaMode", "MASK"},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}}}}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["images"] = {{{"uri", "is-not-there.png"}}};
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  Json second = file.json["meshes"][0]["primitives"][0];
  second["material"] = 1;
  file.json["meshes"][0]["primitives"].push_back(second);
  const ImportedMesh mesh = read(file);
  ASSERT_EQ(mesh.mesh.parts.size(), 2U);
  const Surface& glass = mesh.mesh.parts[0].surface;
  EXPECT_EQ(glass.color.x, 1.0F);
  EXPECT_NEAR(glass.color.y, 0.5F, 1e-3);
  EXPECT_EQ(glass.color.z, 0.0F);
  EXPECT_EQ(glass.transmittance, 0.75F);
  EXPECT_EQ(glass.specular, 0.0F);
  EXPECT_EQ(glass.diffuse, 0.25F);
  const Surface& metal = mesh.mesh.parts[1].surface;
  EXPECT_NEAR(metal.color.x, 0.5F, 1e-3) << "the mean of textures";
  EXPECT_FLOAT_EQ(metal.specular, 0.8F);
  EXPECT_EQ(metal.transmittance, 0.5F);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_EQ(mesh.warnings[0], "1 triangles have alpha-masked materials; they are traced as opaque");
}

TEST_F(Gltf, PointsAndLinesAreCounted) {
  GltfFile file = gltf_triangle();
  for (int mode = 0; mode < 4; ++mode) {  // points, lines, a loop, a strip
    Json primitive = file.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    file.json["meshes"][0]["primitives"].push_back(primitive);
  }
  const ImportedMesh mesh = read(file);
  EXPECT_EQ(mesh.mesh.triangles.size(), 1U);
  ASSERT_EQ(mesh.warnings.size(), 1U);
  EXPECT_EQ(mesh.warnings[0], "9 points and lines were left out");
}

// Refused files

TEST_F(Gltf, ARefusalStatesTheReason) {
  const auto with = [](const auto& change) {
    GltfFile file = gltf_triangle();
    file.add_indices({0, 1, 2}, GltfType::kUShort);
    file.json["meshes"][0]["primitives"][0]["indices"] = 1;
    change(file.json);
    return file;
  };
  const auto refused = [&](const auto& change, std::initializer_list<std::string_view> words) {
    const std::string said = message(with(change));
    EXPECT_TRUE(says(said, words));
    EXPECT_TRUE(says(said, {"a.glb: "}));
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
  };
  EXPECT_EQ(message(with([](Json&) {})), "(nothing thrown)");
  refused([](Json& j) { j["accessors"][0]["count"] = 4; }, {"accessor 0 has 4 elements"});
  refused([](Json& j) { j["accessors"][0]["count"] = std::numeric_limits<std::int64_t>::max(); },
          {"accessor 0 has 9223372036854775807 elements"});
  refused([](Json& j) { j["accessors"][0]["count"] = 0; }, {"accessor 0 has no elements"});
  refused([](Json& j) { j["accessors"][1]["byteOffset"] = 5; }, {"accessor 1 has 3 elements"});
  refused([](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, {"accessor 0 has positions"});
  refused([](Json& j) { j["accessors"][1]["componentType"] = 5126; }, {"accessor 1"});
  refused([](Json& j) { j["bufferViews"][0]["byteLength"] = 99999; }, {"buffer view 0"});
  refused([](Json& j) { j["bufferViews"][0]["byteOffset"] = std::uint64_t{1} << 63U; },
          {"buffer view 0"});
  refused([](Json& j) { j["bufferViews"][0]["buffer"] = 3; }, {"buffer view 0", "buffer 3"});
  refused([](Json& j) { j["bufferViews"][0]["byteStride"] = 4; }, {"accessor 0", "every 4 bytes"});
  refused([](Json& j) { j["accessors"][0].erase("bufferView"); }, {"accessor 0", "buffer view"});
  refused([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 7; },
          {"primitive 0 of mesh 0", "mode 7"});
  refused([](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 2; },
          {"a primitive refers to material 2"});
  refused([](Json& j) { j["accessors"][1]["count"] = 2; },
          {"primitive 0 of mesh 0", "2 corners", "multiple of 3"});
  refused([](Json& j) { j["nodes"][0]["mesh"] = 5; }, {"a node refers to mesh 5"});
  refused([](Json& j) { j["nodes"][0]["children"] = {12}; }, {"refers to node 12"});
  refused([](Json& j) { j["nodes"][0]["matrix"] = {1, 2, 3}; }, {"node 0 has a matrix of 3"});
  refused([](Json& j) { j["nodes"][0]["translation"] = {1e10, 0, 0}; }, {"coordinate", "1e9"});
  refused([](Json& j) { j["nodes"][0].erase("mesh"); }, {"no triangle is in it", "no faces"});
  refused([](Json& j) { j["asset"]["version"] = "1.0"; }, {"glTF 1.0", "convert it"});
  refused([](Json& j) { j.erase("asset"); }, {"cannot be read as a mesh", "asset"});
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "ANY_thing"}) {
    refused([&](Json& j) { j["extensionsRequired"] = {name}; },
            {fmt::format("requires the extension '{}'", name), "not supported"});
  }
}

TEST_F(Gltf, AppearanceExtensionsMayBeRequired) {
  GltfFile file = gltf_triangle();
  file.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform",
                                     "KHR_texture_basisu", "EXT_texture_webp"};
  EXPECT_EQ(read(file).mesh.triangles.size(), 1U);
}

TEST_F(Gltf, AnIndexWithoutAVertexIsNamed) {
  GltfFile file = gltf_triangle();
  const int indices = file.add_indices({0, 1, 3}, GltfType::kUInt);
  file.json["meshes"][0]["primitives"][0]["indices"] = indices;
  EXPECT_TRUE(says(message(file), {"accessor 1 has the index 3", "3 vertices"}));
}

TEST_F(Gltf, TooManyInstancesAreRefusedBeforeAnyIsMade) {
  GltfFile file = gltf_triangle();
  const int indices = file.add_indices(std::vector<std::uint32_t>(60000, 0), GltfType::kUByte);
  file.json["meshes"][0]["primitives"][0]["indices"] = indices;
  Json nodes = Json::array();
  for (int i = 0; i < 14000; ++i) nodes.push_back({{"mesh", 0}});  // 280 million triangles
  file.json.erase("scenes");
  file.json.erase("scene");
  file.json["nodes"] = nodes;
  EXPECT_TRUE(says(message(file), {"more than 268435456 triangles", "reduce"}));
}

// Companions

TEST_F(Gltf, BuffersAreReadOnlyFromItsFolder) {
  const GltfFile file = gltf_triangle();
  fs::create_directories(folder_.path() / "in" / "sub");
  const auto load = [&](const std::string& uri) {
    return load_scene(folder_.write("in/a.gltf", gltf(file, uri)).string());
  };
  folder_.write("in/b.bin", file.buffer);
  folder_.write("in/sub/b c.bin", file.buffer);
  folder_.write("outside.bin", file.buffer);
  fs::create_symlink("../outside.bin", folder_.path() / "in" / "link.bin");
  fs::create_directory_symlink("..", folder_.path() / "in" / "up");
  fs::create_symlink("b.bin", folder_.path() / "in" / "good.bin");
  for (const char* uri : {"b.bin", "./b.bin", "sub/../b.bin", "sub/b%20c.bin", "good.bin"}) {
    EXPECT_EQ(load(uri).triangles.size(), 1U) << uri;
  }
  const std::string absolute = (folder_.path() / "in" / "b.bin").string();
  for (const std::string& uri :
       {std::string("../outside.bin"), std::string("link.bin"), std::string("up/outside.bin"),
        std::string("sub/../../outside.bin"), std::string("%2e%2e/outside.bin"),
        std::string("%2e%2e%2foutside.bin"), std::string("%2E./outside.bin"), absolute,
        "%2f" + absolute.substr(1)}) {
    EXPECT_TRUE(says(thrown_message([&] { load(uri); }),
                     {"a.gltf", "which is not in its folder", "put the file into the folder"}))
        << uri;
  }
  for (const std::string& uri :
       {"file://" + absolute, "file:" + absolute, std::string("file:///etc/passwd")}) {
    EXPECT_TRUE(says(thrown_message([&] { load(uri); }), {"a.gltf", "No such file or directory"}))
        << "an ordinary name, looked up in the file's folder: " << uri;
  }
  ASSERT_EQ(::mkfifo((folder_.path() / "in" / "pipe.bin").c_str(), 0600), 0);
  EXPECT_TRUE(says(thrown_message([&] { load("pipe.bin"); }), {"a.gltf", "not a regular file"}));
  EXPECT_TRUE(says(thrown_message([&] { load("none.bin"); }),
                   {"a.gltf", "none.bin", "No such file or directory"}));
  fs::resize_file(folder_.write("in/large.bin", ""), std::uint64_t{4} << 30U);
  EXPECT_TRUE(says(thrown_message([&] { load("large.bin"); }), {"a.gltf", "more than 4 GiB"}))
      << "the file's own size counts, too";
  folder_.write("in/short.bin", file.buffer.substr(0, 20));
  EXPECT_TRUE(says(thrown_message([&] { load("short.bin"); }), {"a.gltf", "size mismatch"}));
}

TEST_F(Gltf, NamesOfBuffersAreDecodedOrLiteral) {
  const GltfFile file = gltf_triangle();
  struct Case {
    const char* uri;
    const char* name;
  };
  for (const Case& named :
       {Case{"a+b.bin", "a+b.bin"}, Case{"example 10%.bin", "example 10%.bin"},
        Case{"50%25.bin", "50%.bin"}, Case{"50%2b.bin", "50+.bin"}, Case{"a%20b.bin", "a b.bin"},
        Case{"a%zz.bin", "a%zz.bin"}, Case{"a%2", "a%2"}, Case{"%2-%+4.bin", "%2-%+4.bin"},
        Case{"lit%20eral.bin", "lit%20eral.bin"}, Case{"\xC3\xA9.bin", "\xC3\xA9.bin"},
        Case{"%C3%A8.bin", "\xC3\xA8.bin"}}) {
    folder_.write(named.name, file.buffer);
    EXPECT_EQ(read(gltf(file, named.uri)).mesh.triangles.size(), 1U) << named.uri;
  }
  GltfFile other = file;
  other.buffer.back() = '\x01';
  folder_.write("lit eral.bin", other.buffer);
  EXPECT_NE(read(gltf(file, "lit%20eral.bin")).mesh.vertices,
            read(gltf(file, "a%20b.bin")).mesh.vertices)
      << "the decoded name comes first";
}

TEST_F(Gltf, EachOfSeveralBuffersHasItsOwnName) {
  GltfFile file = gltf_triangle();
  const std::string unused(8, '\0');
  const Json parsed = Json::parse(gltf(file, "the + one.bin"));
  Json json = parsed;
  json["buffers"].push_back(
      {{"byteLength", 8}, {"uri", "data:application/octet-stream;base64,AAAAAAAAAAA="}});
  json["buffers"].push_back({{"byteLength", 8}, {"uri", "other%.bin"}});
  folder_.write("the + one.bin", file.buffer);
  folder_.write("other%.bin", unused);
  EXPECT_EQ(read(json.dump()).mesh.triangles.size(), 1U);
  json["buffers"][2]["uri"] = "none%.bin";
  EXPECT_TRUE(says(thrown_message([&] { read(json.dump()); }), {"none%.bin", "No such file"}));
  GltfFile binary = gltf_triangle();
  binary.json["buffers"].push_back({{"byteLength", 8}, {"uri", "other%.bin"}});
  EXPECT_EQ(read(binary).mesh.triangles.size(), 1U) << "in a .glb file, too";
}

TEST_F(Gltf, IsReadAgainWhenTheDecodedNameOfABufferAppears) {
  GltfFile file = gltf_triangle();
  const std::string path = folder_.write("a.gltf", gltf(file, "b%20c.bin")).string();
  folder_.write("b%20c.bin", file.buffer);
  const std::uint64_t first = scene_hash(load_scene(path));
  EXPECT_EQ(scene_hash(load_scene(path)), first);
  file.buffer.back() = '\x01';
  folder_.write("b c.bin", file.buffer);
  EXPECT_NE(scene_hash(load_scene(path)), first);
}

TEST_F(Gltf, IsReadAgainWhenABufferChanges) {
  GltfFile file = gltf_triangle();
  const std::string path = folder_.write("a.gltf", gltf(file, "b.bin")).string();
  folder_.write("b.bin", file.buffer);
  const std::uint64_t first = scene_hash(load_scene(path));
  EXPECT_EQ(scene_hash(load_scene(path)), first);
  file.buffer.back() = '\x01';
  folder_.write("b.bin", file.buffer);
  EXPECT_NE(scene_hash(load_scene(path)), first);
}

// Malformed files

/// Reads in this process, so that a sanitizer detects faults.
void expect_mesh_or_refusal(const std::string& bytes, const fs::path& path) {
  try {
    EXPECT_FALSE(mesh::import_mesh(bytes, "glb", path).mesh.triangles.empty());
  } catch (const InputError& error) {
    const std::string_view said = error.what();
    EXPECT_TRUE(says(said, {path.filename().string()}));
    EXPECT_EQ(said.find('\n'), std::string_view::npos) << said;
  }
}

/// Returns a file that uses every feature of glTF that is read.
GltfFile rich_file() {
  GltfFile file = with_camera({{"name", "eye"}, {"camera", 0}}, {{"yfov", 0.5}, {"znear", 0.1}});
  const int strip = file.add_indices({0, 1, 2, 0}, GltfType::kUByte);
  file.add_node({{"mesh", file.add_mesh(0, strip, kStrip)},
                 {"rotation", rotation_json({0.0, 1.0, 0.0}, 30.0)},
                 {"children", Json::array()}});
  file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0, 1}}}}}};
  file.json["meshes"][1]["primitives"][0]["material"] = 0;
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  add_light(file, 0, {{"translation", {3, 3, 3}}});
  const int indices = file.add_view(std::string("\1", 1));
  const Json view = file.json["accessors"][file.add_positions({{0.0F, 7.0F, 0.0F}})]["bufferView"];
  file.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", view}}}};
  return file;
}

TEST_F(Gltf, ATruncatedFileIsRefused) {
  for (const std::string& whole : {glb(rich_file()), gltf(rich_file())}) {
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 50) {
      SCOPED_TRACE(size);
      EXPECT_TRUE(says(thrown_message([&] { read(whole.substr(0, size)); }), {"a.gltf"}));
    }
  }
}

TEST_F(Gltf, ADamagedFileIsReadOrRefused) {
  const std::array<std::string, 2> files{glb(rich_file()), gltf(rich_file())};
  Random random(2026);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = files[random.below(2)];
    for (auto changes = 1 + random.below(4); changes > 0; --changes) {
      char& c = damaged[random.below(damaged.size())];
      // Digits are as frequent as other bytes because they change indices and counts.
      c = random.unit() < 0.5 ? static_cast<char>('0' + random.below(10))
                              : static_cast<char>(random.below(256));
    }
    SCOPED_TRACE(damaged);
    expect_mesh_or_refusal(damaged, folder_.path() / "a.glb");
  }
}

}  // namespace
}  // namespace beambench::scenes
