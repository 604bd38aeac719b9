#include <chrono>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <zlib.h>

#include "scenes/base/process_memory.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/fitted_cameras.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::scenes {
namespace {

namespace fs = std::filesystem;

/// A folder for mesh files, which contains its own cache.
class Meshes : public testing::Test {
 protected:
  Meshes() { ::setenv("BEAMBENCH_CACHE", cache().c_str(), 1); }
  ~Meshes() override { ::unsetenv("BEAMBENCH_CACHE"); }

  void SetUp() override {
    for (const char* ending : {"gltf", "obj", "ply"}) {
      if (mesh::importer_of(ending).empty()) GTEST_SKIP() << "built without an importer";
    }
  }

  fs::path cache() const { return folder_.path() / "cache"; }
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text).string();
  }
  std::string message(const std::string& name, const std::string& text) const {
    const std::string path = write(name, text);
    return thrown_message([&] { load_scene(path); });
  }
  std::vector<fs::path> cached() const {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(cache() / "meshes", none)) {
      files.push_back(entry.path());
    }
    return files;
  }
  void register_mesh(const std::string& name, const std::string& json) const {
    fs::create_directories(cache() / "registered");
    std::ofstream(cache() / "registered" / (name + ".json")) << json;
  }

  TemporaryFolder folder_;
};

std::string gzipped(const std::string& text, const fs::path& path) {
  const gzFile file = ::gzopen(path.c_str(), "wb");
  ::gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  ::gzclose(file);
  return read_text(path);
}

void expect_tetrahedron(const Scene& scene) {
  EXPECT_EQ(scene.polygons.size(), 4U);
  EXPECT_EQ(scene.primitives.size(), 4U);
  EXPECT_EQ(scene.vertices.size(), 4U) << "vertices at the same place must be merged";
  EXPECT_EQ(scene.bounds.extent(), glm::vec3(1.0F, 2.0F, 3.0F));
  EXPECT_FALSE(scene.lights.empty());
}

TEST_F(Meshes, InEveryFormatAreTheSameScene) {
  for (const auto& [name, text] : tetrahedron_files()) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(write(name, text));
    expect_tetrahedron(scene);
    EXPECT_EQ(scene.name, (folder_.path() / name).string());
  }
  gzipped(tetrahedron_ply(), folder_.path() / "packed.ply.gz");
  expect_tetrahedron(load_scene((folder_.path() / "packed.ply.gz").string()));
  expect_tetrahedron(load_scene(write("UPPER.OBJ", tetrahedron_obj())));
}

TEST_F(Meshes, MatchTheirFilesBitForBit) {
  const Scene scene = load_scene(write("a.obj", "v 0.1 0 0\nv 1e-20 1 0\nv 0 0.3 -7\nf 1 2 3\n"));
  ASSERT_EQ(scene.triangles.size(), 1U);
  EXPECT_EQ(scene.vertices[scene.triangles[0].vertex[0]], glm::vec3(0.1F, 0.0F, 0.0F));
  EXPECT_EQ(scene.vertices[scene.triangles[0].vertex[1]], glm::vec3(1e-20F, 1.0F, 0.0F));
  EXPECT_EQ(scene.vertices[scene.triangles[0].vertex[2]], glm::vec3(0.0F, 0.3F, -7.0F));
}

TEST_F(Meshes, PolygonsBecomeTriangles) {
  const Scene scene =
      load_scene(write("quad.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\nf 1 2 3\n"));
  EXPECT_EQ(scene.polygons.size(), 3U);
}

TEST_F(Meshes, TakeTheColorsOfTheirMaterials) {
  write("paint.mtl", "newmtl red\nKd 1 0 0\nnewmtl window\nKd 0 0 1\nd 0.25\n");
  const std::string path = write(
      "painted.obj",
      "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl window\nf 1 3 2\n");
  const Scene scene = load_scene(path);
  ASSERT_EQ(scene.surfaces.size(), 2U);
  EXPECT_EQ(scene.surfaces[0].color, glm::vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(scene.surfaces[0].transmittance, 0.0F);
  EXPECT_EQ(scene.surfaces[1].color, glm::vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(scene.surfaces[1].transmittance, 0.75F);
}

TEST_F(Meshes, TrianglesWithoutAreaAreLeftOutAndCounted) {
  const std::string path = write("some.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 2\nf 1 2 4\n"
                                 "f 3 2 1\nl 1 2\np 3\n");
  for (int time = 0; time < 2; ++time) {  // from the file, and from the cache
    std::vector<std::string> warnings;
    const Scene scene = load_scene(path, &warnings);
    EXPECT_EQ(scene.polygons.size(), 2U);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_TRUE(says(
        warnings[0],
        {"some.obj: ", "2 triangles without area were left out, the first of them triangle 1"}));
    EXPECT_TRUE(says(warnings[1], {"some.obj: ", "2 points and lines were left out"}));
  }
  EXPECT_TRUE(says(thrown_message([&] { load_scene(path, nullptr, {.strict = true}); }),
                   {"some.obj", "without area", "--strict"}));
}

// Refused files, and the reasons

TEST_F(Meshes, ARefusalStatesTheReason) {
  EXPECT_TRUE(says(message("empty.obj", ""), {"empty.obj", "the file is empty"}));
  EXPECT_TRUE(
      says(message("text.stl", "These are no triangles."), {"text.stl", "export it again"}));
  EXPECT_TRUE(says(message("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\np 1 2 3\n"),
                   {"points.obj", "no triangle is in it"}));
  EXPECT_TRUE(says(message("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
                   {"line.obj", "no triangle", "without area"}));
  EXPECT_TRUE(says(message("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
                   {"index.obj", "cannot be read as a mesh", "export it again"}));
  EXPECT_TRUE(says(message("packed.ply.gz", "no gzip data"), {"packed.ply.gz", "gzip", "damaged"}));
  EXPECT_TRUE(
      says(message("house.skp", "x"), {"house.skp", ".skp files cannot be read", "obj, off"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene("no-such.ply"); }),
                   {"no-such.ply", "cannot be read", "No such file"}));
  fs::create_directory(folder_.path() / "folder.obj");
  EXPECT_TRUE(says(thrown_message([&] { load_scene((folder_.path() / "folder.obj").string()); }),
                   {"folder.obj", "is a folder"}));
}

TEST_F(Meshes, NumbersThatNoSceneCanHoldAreRefused) {
  for (const auto& [name, text] : tetrahedron_files()) {
    if (!name.ends_with(".obj") && !name.ends_with(".off") && name != "text.ply" &&
        name != "text.stl") {
      continue;
    }
    for (const char* number : {"nan", "1e10"}) {
      SCOPED_TRACE(name + std::string(" ") + number);
      EXPECT_TRUE(says(message(name, with_coordinate(text, number)), {name, "coordinate", "1e9"}));
    }
  }
}

TEST_F(Meshes, AFileThatIsCutOffIsRefused) {
  const std::string text = tetrahedron_ply();
  const std::string binary = tetrahedron_binary_ply();
  EXPECT_TRUE(says(message("cut.ply", text.substr(0, text.size() - 9)),
                   {"cut.ply", "declares 4 of the element 'face'", "after 3", "cut off"}));
  EXPECT_TRUE(says(message("cut.ply", binary.substr(0, binary.size() - 1)),
                   {"face 3: the file ends within it", "cut off"}));
  EXPECT_TRUE(says(message("cut.ply", binary.substr(0, binary.size() - 4 * 13 - 1)),
                   {"vertex 3: the file ends within it", "cut off"}));
  const fs::path packed = folder_.path() / "cut.ply.gz";
  const std::string bytes = gzipped(text, packed);
  EXPECT_TRUE(says(message("cut.ply.gz", bytes.substr(0, bytes.size() / 2)), {"cut off"}));
  EXPECT_TRUE(says(message("claims.ply", with_count(text, "face 4", "face 4000000000")),
                   {"4000000000", "cut off"}));
}

// Compressed files

TEST_F(Meshes, NothingUnpacksToNothing) {
  EXPECT_TRUE(says(thrown_message([] { mesh::gunzip("", "empty.ply.gz"); }),
                   {"empty.ply.gz", "damaged or cut off"}));
  gzipped("", folder_.path() / "packed.ply.gz");
  EXPECT_TRUE(says(thrown_message([&] { load_scene((folder_.path() / "packed.ply.gz").string()); }),
                   {"packed.ply.gz", "unpacks to an empty file"}));
}

/// The file unpacks to 400 MiB of the same byte.
TEST_F(Meshes, ExcessiveCompressionRatiosAreRefusedEarly) {
  const fs::path path = folder_.path() / "bomb.ply.gz";
  const gzFile file = ::gzopen(path.c_str(), "wb");
  const std::string block(std::size_t{1} << 20U, ' ');
  for (int i = 0; i < 400; ++i) ::gzwrite(file, block.data(), static_cast<unsigned>(block.size()));
  ::gzclose(file);
  const std::string packed = read_text(path);
  std::string refusal;
  const auto growth =
      peak_memory_growth([&] { refusal = thrown_message([&] { mesh::gunzip(packed, path); }); });
  EXPECT_TRUE(says(refusal, {"bomb.ply.gz", "more than 200 times", "unpack it yourself"}));
  EXPECT_LT(growth.value_or(0), std::uint64_t{256} << 20U);
}

/// Numbers in sequence compress well, as do the vertices of a regular grid.
TEST_F(Meshes, GoodCompressionRatiosAreAccepted) {
  std::string text;
  while (text.size() < (std::size_t{70} << 20U)) {
    text += fmt::format("v {} 1.000000 0.000000\n", text.size());
  }
  const std::string packed = gzipped(text, folder_.path() / "grid.obj.gz");
  EXPECT_EQ(mesh::gunzip(packed, "grid.obj.gz"), text);
}

// The limits of an import

TEST_F(Meshes, AnImportThatTakesTooLongIsEnded) {
  mesh::ImportLimits limits = mesh::import_limits("", "obj");
  limits.elapsed = std::chrono::milliseconds(1);
  std::string text = tetrahedron_obj();
  while (text.size() < 4'000'000) text += "f 1 2 3\nf 1 3 2\n";
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(says(thrown_message([&] { mesh::guarded_import(text, "obj", "slow.obj", limits); }),
                   {"slow.obj", "took more than 0.001 s by the clock"}));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(ImportLimits, GrowWithTheFileUpToTheAvailableMemory) {
  const std::string bytes(std::size_t{3} << 20U, ' ');
  EXPECT_EQ(mesh::import_limits(bytes, "obj").processor, std::chrono::seconds(5));
  EXPECT_EQ(mesh::import_limits(bytes, "glb").processor, std::chrono::seconds(123));
  EXPECT_EQ(mesh::import_limits(bytes, "obj").elapsed, std::chrono::seconds(80));
  ::setenv("BEAMBENCH_MEMORY", "1", 1);
  EXPECT_EQ(mesh::import_limits(bytes, "obj").memory, 0U);
  ::unsetenv("BEAMBENCH_MEMORY");
}

/// Any file becomes a scene or is refused, even if Assimp crashes. The damage is drawn with fixed
/// seeds instead of RapidCheck because some damage keeps Assimp busy until its time is up.
TEST_F(Meshes, DamagedFilesAreRefusedOrRead) {
  const auto files = tetrahedron_files();
  Random random(1999);
  for (int i = 0; i < 48; ++i) {
    const auto& [name, text] = files[random.below(files.size())];
    std::string damaged = text;
    if (random.unit() < 0.4) damaged.resize(1 + random.below(text.size() - 1));
    for (auto changes = random.below(4); changes > 0; --changes) {
      damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
    }
    const std::string path = write(name, damaged);
    try {
      EXPECT_FALSE(load_scene(path).primitives.empty()) << damaged;
    } catch (const InputError& error) {
      EXPECT_TRUE(says(error.what(), {name})) << damaged;
    }
  }
}

// The cache

TEST_F(Meshes, AreTheSameFromTheCache) {
  const std::string path = write("a.obj", tetrahedron_obj());
  const Scene first = load_scene(path);
  ASSERT_EQ(cached().size(), 1U);
  const auto written = fs::last_write_time(cached()[0]);
  const Scene second = load_scene(path);
  EXPECT_EQ(scene_hash(first), scene_hash(second));
  EXPECT_EQ(first.cameras.front().from, second.cameras.front().from);
  EXPECT_EQ(fs::last_write_time(cached()[0]), written) << "the file was imported a second time";
  const Scene other = load_scene(write("a.obj", tetrahedron_obj() + "f 1 3 2\n"));
  EXPECT_EQ(other.polygons.size(), 5U) << "a different file of the same name is a different mesh";
}

TEST_F(Meshes, AreReadAgainWhenTheirMaterialsChange) {
  const std::string path =
      write("a.obj", "mtllib m.mtl\nusemtl x\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene without = load_scene(path);
  write("m.mtl", "newmtl x\nKd 1 0 0\n");
  EXPECT_EQ(load_scene(path).surfaces[0].color, glm::vec3(1.0F, 0.0F, 0.0F));
  write("m.mtl", "newmtl x\nKd 0 1 0\n");
  EXPECT_EQ(load_scene(path).surfaces[0].color, glm::vec3(0.0F, 1.0F, 0.0F));
  fs::remove(folder_.path() / "m.mtl");
  EXPECT_EQ(load_scene(path).surfaces[0].color, without.surfaces[0].color);
}

TEST_F(Meshes, DamagedCacheFilesAreDetectedAndReplaced) {
  const std::string path = write("a.obj", tetrahedron_obj());
  const std::uint64_t hash = scene_hash(load_scene(path));
  ASSERT_EQ(cached().size(), 1U);
  const fs::path file = cached()[0];
  const std::string good = read_text(file);
  const auto expect_repair = [&](const std::string& bad) {
    std::ofstream(file, std::ios::binary) << bad;
    std::vector<std::string> warnings;
    EXPECT_EQ(scene_hash(load_scene(path, &warnings)), hash);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_TRUE(says(warnings[0], {"a.obj", "damaged", "made again"}));
    EXPECT_EQ(read_text(file), good);
  };
  for (std::size_t size = 0; size < good.size(); size += 7) expect_repair(good.substr(0, size));
  for (std::size_t at = 0; at < good.size(); at += 5) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x10);
    expect_repair(bad);
  }
  expect_repair(good + "more");
  std::string older = good;
  older[15] = '1';
  std::ofstream(file, std::ios::binary) << older;
  std::vector<std::string> warnings;
  EXPECT_EQ(scene_hash(load_scene(path, &warnings)), hash);
  EXPECT_TRUE(warnings.empty()) << "a cache file of an earlier version causes no warning";
  EXPECT_EQ(cached().size(), 1U) << "the earlier file is removed";
}

TEST_F(Meshes, LoadWithoutACache) {
  const std::string path = write("a.obj", tetrahedron_obj());
  ::setenv("BEAMBENCH_CACHE", write("a-file", "in the way").c_str(), 1);
  std::vector<std::string> warnings;
  expect_tetrahedron(load_scene(path, &warnings));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(says(warnings[0], {"cannot be written", "BEAMBENCH_CACHE"}));
}

// Cameras

Camera camera_named(const Scene& scene, std::string_view name) {
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
  }
  ADD_FAILURE() << "no camera " << name;
  return {};
}

glm::vec3 backward(const Camera& camera) { return camera.from - camera.at; }

TEST_F(Meshes, HaveStandardViews) {
  const Scene scene = load_scene(write("a.obj", tetrahedron_obj()));
  EXPECT_EQ(scene.cameras.front().name, "three-quarter");
  EXPECT_GT(backward(camera_named(scene, "front")).z, 0.0F);
  EXPECT_GT(backward(camera_named(scene, "side")).x, 0.0F);
  EXPECT_GT(backward(camera_named(scene, "top")).y, 0.0F);
  EXPECT_EQ(camera_named(scene, "top").up, glm::vec3(0.0F, 0.0F, -1.0F));
  const Scene printed = load_scene(write("a.stl", tetrahedron_stl()));
  EXPECT_LT(backward(camera_named(printed, "front")).y, 0.0F);
  EXPECT_GT(backward(camera_named(printed, "top")).z, 0.0F);
}

RC_GTEST_PROP(FittedCameras, SeeAllPointsAndFillTheImage, ()) {
  const auto size = *rc::gen::element(1e-6, 1.0, 1e6);
  const auto coordinate = rc::gen::map(
      rc::gen::inRange(-1000, 1001), [size](int i) { return static_cast<float>(1e-3 * i * size); });
  std::vector<glm::vec3> points;
  const int count = *rc::gen::inRange(3, 12);
  for (int i = 0; i < count; ++i) points.emplace_back(*coordinate, *coordinate, *coordinate);
  const auto [up, front] = *rc::gen::element(std::pair("y", "z"), std::pair("z", "-y"),
                                             std::pair("-z", "y"), std::pair("x", "-y"));
  const auto cameras =
      mesh::fitted_cameras(points, {*mesh::parse_axis(up), *mesh::parse_axis(front)});
  RC_ASSERT(cameras.size() == 4U);
  for (const Camera& camera : cameras) {
    SceneBuilder("accepts").add_camera(camera);
    const glm::dvec3 eye(camera.from);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.at) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(camera.up)));
    const glm::dvec3 upright = glm::cross(right, forward);
    double widest = 0.0;
    for (const glm::vec3& point : points) {
      const glm::dvec3 to_point = glm::dvec3(point) - eye;
      const double depth = glm::dot(to_point, forward);
      RC_ASSERT(depth >= 0.0);
      for (const glm::dvec3& axis : {right, upright}) {
        widest = std::max(widest, std::abs(glm::dot(to_point, axis)) / depth);
      }
    }
    RC_ASSERT(widest < std::tan(0.125 * 3.14159265));
  }
}

TEST_F(Meshes, FarOrHugeOnesHaveACamera) {
  EXPECT_EQ(
      load_scene(write("far.obj", "v 1e8 0 0\nv 1e8 1 0\nv 1e8 0 1\nf 1 2 3\n")).cameras.size(),
      4U);
  EXPECT_EQ(
      load_scene(write("huge.obj", "v 9e8 0 0\nv -9e8 1 0\nv 0 0 9e8\nf 1 2 3\n")).cameras.size(),
      1U);
}

// The registry

TEST_F(Meshes, AreFoundByTheirRegisteredName) {
  write("a.obj", tetrahedron_obj());
  register_mesh("shape",
                R"({"path": "../../a.obj", "up": "-z", "front": "y", "about": "A test."})");
  const Scene scene = load_scene("mesh:shape");
  EXPECT_EQ(scene.name, "mesh:shape");
  expect_tetrahedron(scene);
  EXPECT_LT(backward(camera_named(scene, "top")).z, 0.0F);
  EXPECT_EQ(mesh::registered_mesh_names(), std::vector<std::string>{"shape"});
  EXPECT_EQ(mesh::find_registered_mesh("shape").about, "A test.");
}

TEST_F(Meshes, HaveTheCamerasAndLightsOfTheirEntry) {
  write("a.obj", tetrahedron_obj());
  register_mesh("shape", R"({"path": "../../a.obj", "cameras": [
    {"name": "hall", "from": [5, 1, 2], "at": [0, 1, 2], "angle": 70},
    {"name": "top", "from": [0, 9, 0], "at": [0, 0, 0], "up": [1, 0, 0]}],
    "lights": [[1, 2, 3], [4, 5, 6], [7, 8, 9], [0, 1, 2]], "sha256": "skipped"})");
  const Scene scene = load_scene("mesh:shape");
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) names.push_back(camera.name);
  EXPECT_EQ(names, (std::vector<std::string>{"hall", "top", "three-quarter", "front", "side"}));
  EXPECT_EQ(scene.cameras[0].from, glm::vec3(5.0F, 1.0F, 2.0F));
  EXPECT_EQ(scene.cameras[0].up, glm::vec3(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(scene.cameras[0].angle, 70.0F);
  EXPECT_EQ(scene.cameras[1].up, glm::vec3(1.0F, 0.0F, 0.0F));
  ASSERT_EQ(scene.lights.size(), 4U);
  EXPECT_EQ(scene.lights[1].position, glm::vec3(4.0F, 5.0F, 6.0F));
  EXPECT_EQ(scene.lights[1].color, glm::vec3(0.5F));
}

TEST_F(Meshes, AnEntryWithAWrongCameraOrLightIsNamed) {
  write("a.obj", tetrahedron_obj());
  const auto camera = [](const std::string& keys) {
    return R"("cameras": [{"name": "hall", )" + keys + "}]";
  };
  for (const auto& [keys, why] : std::vector<std::pair<std::string, std::string>>{
           {R"("cameras": {})", "'cameras' must be a list"},
           {R"("cameras": [7])", "must be an object"},
           {R"("cameras": [{"from": [0, 0, 1], "at": [0, 0, 0]}])", "must have a 'name'"},
           {camera(R"("at": [0, 0, 0])"), "'from' of camera 'hall' must be three numbers"},
           {camera(R"("from": [0, 0], "at": [0, 0, 0])"), "'from' of camera 'hall'"},
           {camera(R"("from": [0, 0, "1"], "at": [0, 0, 0])"), "'from' of camera 'hall'"},
           {camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "angel": 3)"), "'angel'"},
           {camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "angle": "3")"), "a number of degrees"},
           {camera(R"("from": [0, 0, 1], "at": [0, 0, 0], "angle": 180)"), "between 0 and 180"},
           {camera(R"("from": [0, 0, 1], "at": [0, 0, 1])"), "the point looked at"},
           {camera(R"("from": [0, 1, 0], "at": [0, 0, 0])"), "parallel to the view"},
           {camera(R"("from": [0, 1e20, 0], "at": [0, 0, 0])"), "from -1e9 to 1e9"},
           {R"("cameras": [{"name": "a", "from": [0, 0, 1], "at": [0, 0, 0]},
                           {"name": "a", "from": [0, 0, 1], "at": [0, 0, 0]}])",
            "two cameras are named 'a'"},
           {R"("lights": 3)", "'lights' must be a list"},
           {R"("lights": [[1, 2]])", "each of 'lights' must be three numbers"},
           {R"("lights": [[1, 2, 1e10]])", "from -1e9 to 1e9"}}) {
    register_mesh("broken", R"({"path": "../../a.obj", )" + keys + "}");
    const std::string message = thrown_message([] { load_scene("mesh:broken"); });
    EXPECT_TRUE(says(message, {"broken.json: ", why, "scripts/meshes"})) << keys << '\n' << message;
  }
}

TEST_F(Meshes, AnUnknownNameExplainsHowToGetMore) {
  EXPECT_TRUE(says(thrown_message([] { load_scene("mesh:dragon"); }),
                   {"'dragon'", "none is", "scripts/meshes"}));
  register_mesh("dragon", R"({"path": "../gone.obj"})");
  EXPECT_TRUE(says(thrown_message([] { load_scene("mesh:dragn"); }),
                   {"'dragn'", "did you mean 'mesh:dragon'", "scripts/meshes"}));
  EXPECT_TRUE(
      says(thrown_message([] { load_scene("mesh:dragon"); }), {"gone.obj", "No such file"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene("mesh:"); }), {"no mesh ''"}));
  EXPECT_TRUE(says(thrown_message([] { load_scene("mesh:../x"); }), {"no mesh '../x'"}));
}

TEST_F(Meshes, AMalformedEntryIsNamed) {
  for (const char* json : {"", "{", "[]", "3", R"({"path": 3})", "{}", R"({"path": "a.txt"})",
                           R"({"path": "a.obj", "up": "w"})", R"({"path": "a.obj", "up": "z"})"}) {
    register_mesh("broken", json);
    EXPECT_TRUE(
        says(thrown_message([] { load_scene("mesh:broken"); }), {"broken.json", "scripts/meshes"}))
        << json;
  }
}

// Parts

TEST(MeshFormat, IsRecognizedByTheEnding) {
  EXPECT_EQ(mesh::mesh_ending("a/b.PLY"), "ply");
  EXPECT_EQ(mesh::mesh_ending("dragon.ply.gz"), "ply");
  EXPECT_EQ(mesh::mesh_ending("scene.nff"), "");
  EXPECT_EQ(mesh::mesh_ending("a.obj/file"), "");
  EXPECT_EQ(mesh::mesh_ending("obj"), "");
}

TEST(MeshCodec, ReturnsWhatItEncoded) {
  mesh::ImportedMesh mesh{
      {{{1.0F, 2.0F, 3.0F}, {0.0F, 1.0F, 0.0F}, {4.0F, 0.0F, 0.0F}},
       {{0, 1, 2}},
       {{{.color = {0.5F, 0.0F, 1.0F}}, 1}}},
      {{.name = "eye", .from = {1.0F, 2.0F, 3.0F}, .angle = 30.0F, .width = 77}},
      {{{1.0F, 0.0F, 2.0F}, {0.5F, 1.0F, 2.0F}}},
      {"a warning"},
      {{"paint.mtl", 42}}};
  const std::string bytes = mesh::encode(mesh);
  const mesh::ImportedMesh again = mesh::decode(bytes);
  EXPECT_EQ(again.mesh.vertices, mesh.mesh.vertices);
  EXPECT_EQ(again.mesh.triangles, mesh.mesh.triangles);
  EXPECT_EQ(again.mesh.parts, mesh.mesh.parts);
  EXPECT_EQ(again.cameras[0].name, "eye");
  EXPECT_EQ(again.cameras[0].from, mesh.cameras[0].from);
  EXPECT_EQ(again.cameras[0].angle, 30.0F);
  EXPECT_EQ(again.cameras[0].width, 77);
  EXPECT_EQ(again.lights[0].position, mesh.lights[0].position);
  EXPECT_EQ(again.lights[0].color, mesh.lights[0].color);
  EXPECT_EQ(again.warnings, mesh.warnings);
  EXPECT_EQ(again.companions[0].hash, 42U);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(mesh::decode(bytes.substr(0, size)), std::out_of_range) << size;
  }
}

TEST(MeshCollector, MergesCoincidentVertices) {
  mesh::MeshCollector collector;
  for (int i = 0; i < 100; ++i) {
    const auto x = static_cast<float>(i);
    collector.add({glm::vec3(x, 0.0F, 0.0F), {x + 1.0F, 0.0F, 0.0F}, {x, 1.0F, -0.0F}});
    collector.add({glm::vec3(x + 1.0F, 0.0F, 0.0F), {x + 1.0F, 1.0F, 0.0F}, {x, 1.0F, 0.0F}});
  }
  const mesh::TriangleMesh mesh = std::move(collector).finish();
  EXPECT_EQ(mesh.triangles.size(), 200U);
  EXPECT_EQ(mesh.vertices.size(), 202U);
}

}  // namespace
}  // namespace beambench::scenes
