// The data of pages: meshes, cells and paths are those of the scene and the structure.

#include "harness/explain/explanation.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/inspector_of.hpp"
#include "harness/explain/display_mesh.hpp"
#include "harness/explain/explain_page.hpp"
#include "harness/explain/packed_arrays.hpp"
#include "harness/explain/shown_cells.hpp"
#include "harness/explain/shown_paths.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::explain {
namespace {

std::vector<accel::StructureChoice> chosen(std::string_view list) {
  return accel::registry().choose_list(list);
}

const auto ignore = [](double) {};

rays::ImageOfRays small_image(const scenes::Scene& scene) {
  return rays::image_of(scene.cameras.front(), rays::Resolution{16, 12}, 1);
}

TEST(Base64, EncodesTheExamplesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(PackedArrays, BeginAtMultiplesOfFour) {
  PackedArrays arrays;
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  const std::array<float, 2> floats{0.5F, 1.5F};
  EXPECT_EQ(arrays.add(bytes), nlohmann::json({{"type", "Uint8"}, {"at", 0}, {"count", 3}}));
  EXPECT_EQ(arrays.add(floats), nlohmann::json({{"type", "Float32"}, {"at", 4}, {"count", 2}}));
  EXPECT_FALSE(arrays.text().empty());
}

TEST(DisplayMesh, HasTheTrianglesOfSmallScenes) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const DisplayMesh mesh = display_mesh(scene);
  EXPECT_EQ(mesh.triangles.size(), scene.triangles.size());
  EXPECT_EQ(mesh.triangles_of_scene, scene.triangles.size());
  EXPECT_EQ(mesh.primitives.back(), scene.triangles.back().primitive);
}

TEST(DisplayMesh, HasConesButLeavesSpheresToTheViewer) {
  const DisplayMesh cones = display_mesh(scenes::load_scene("tree:n=2"));
  EXPECT_GT(cones.triangles.size(), 0U);
  EXPECT_EQ(cones.triangles.size(), cones.primitives.size());
  const scenes::Scene balls = scenes::load_scene("balls:n=1");
  EXPECT_EQ(display_mesh(balls).triangles.size(), balls.triangles.size());
}

TEST(DisplayMesh, IsDecimatedToTheLimitAndKeepsTheExtent) {
  const scenes::Scene scene = scenes::load_scene("mount:n=6");
  constexpr std::size_t kMost = 500;
  const DisplayMesh mesh = display_mesh(scene, kMost);
  EXPECT_EQ(mesh.triangles_of_scene, scene.triangles.size());
  ASSERT_GT(scene.triangles.size(), kMost);
  EXPECT_LE(mesh.triangles.size(), kMost);
  EXPECT_GT(mesh.triangles.size(), kMost / 4);
  EXPECT_EQ(mesh.primitives.size(), mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) {
    EXPECT_LT(*std::ranges::max_element(triangle), mesh.corners.size());
  }
}

TEST(ShownCells, AreOccupiedLeavesByLevel) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const auto structure = chosen("samet:max_level=4").front().build(scene);
  const ShownCells shown = shown_cells(*structure, {});
  EXPECT_EQ(shown.kind, "occupied leaves");
  EXPECT_EQ(shown.of, shown.cells.size());
  const scenes::Bounds& bounds = scene.bounds;
  for (const accel::Cell& cell : shown.cells) {
    ASSERT_GE(cell.level, 1);
    ASSERT_LE(cell.level, 4);
    const double root =
        static_cast<double>(std::max({bounds.extent().x, bounds.extent().y, bounds.extent().z}));
    const double side = cell.box.upper.x - cell.box.lower.x;
    EXPECT_NEAR(side * (1 << (cell.level - 1)), root, 0.01 * root);
  }
}

TEST(ShownCells, AreTheNodesOfAHierarchyWithTheRootFirst) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  for (const char* name : {"sah-bvh", "goldsmith-salmon", "tile-beam"}) {
    const auto structure = chosen(name).front().build(scene);
    const ShownCells shown = shown_cells(*structure, {});
    EXPECT_EQ(shown.kind, "nodes") << name;
    ASSERT_GT(shown.cells.size(), 1U) << name;
    EXPECT_EQ(shown.cells[0].level, 1) << name;
    EXPECT_EQ(shown.cells[1].level, 2) << name;
    for (const accel::Cell& cell : shown.cells) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(cell.box.lower[axis], shown.cells[0].box.lower[axis]) << name;
        EXPECT_LE(cell.box.upper[axis], shown.cells[0].box.upper[axis]) << name;
      }
    }
  }
}

TEST(ShownCells, AreThePlacesThatRaysEnteredIfNothingElseIsKnown) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const auto structure = chosen("exhaustive").front().build(scene);
  const std::vector<accel::Cell> visited(5);
  EXPECT_EQ(shown_cells(*structure, visited).cells.size(), 5U);
  const ShownCells few = shown_cells(*structure, visited, 2);
  EXPECT_EQ(few.cells.size(), 2U);
  EXPECT_EQ(few.of, 5U);
}

// A page takes the closest of a path's tests as the hit.
TEST(Paths, EndInTheHitOfTheImage) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const accel::PrimaryRays rays = small_image(scene).rays();
  for (const char* name : {"samet", "glassner", "gargantini", "voxel-grid", "hierarchical-grid",
                           "kd-tree", "sah-bvh", "goldsmith-salmon", "beam", "tile-beam"}) {
    const auto structure = chosen(name).front().build(scene);
    accel::HitBuffer hits(rays.width(), rays.height(), 1);
    structure->closest_hits(rays, hits, {});
    const PathTable paths = follow_image(*structure, rays, {}, ignore);
    ASSERT_EQ(paths.first_step.size(), rays.count() + 1) << name;
    ASSERT_EQ(paths.first_beam.size(), rays.count() + 1) << name;
    ASSERT_EQ(paths.first_test.size(), paths.place.size() + 1) << name;
    for (std::size_t ray = 0; ray < rays.count(); ++ray) {
      float best = accel::kInfinity;
      const std::size_t begin = paths.first_test[paths.first_step[ray]];
      const std::size_t end = paths.first_test[paths.first_step[ray + 1]];
      for (std::size_t i = begin; i < end; ++i) {
        if (accel::is_hit(paths.t[i])) best = std::min(best, paths.t[i]);
      }
      const auto hit = hits.get(ray);
      if (std::string_view(name) == "tile-beam") {  // images use different arithmetic
        EXPECT_EQ(best < accel::kInfinity, hit.has_value()) << name << ' ' << ray;
      } else {
        EXPECT_EQ(best, hit ? hit->t : accel::kInfinity) << name << ' ' << ray;
      }
    }
  }
}

// To return the path of one sample, the inspector traces the whole image; its leaves are the same.
TEST(Paths, FollowTheLeavesInTheBeamsOfTheImage) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const accel::PrimaryRays rays = small_image(scene).rays();
  const auto structure = chosen("beam").front().build(scene);
  const accel::Inspector& inspector = accel::inspector_of(*structure);
  const auto beams = inspector.beams(rays).value();
  const PathTable paths = follow_image(*structure, rays, beams, ignore);
  std::size_t same = 0;
  for (std::size_t ray = 0; ray < rays.count(); ++ray) {
    const auto x = static_cast<int>(ray) % rays.width();
    const auto y = static_cast<int>(ray) / rays.width();
    const std::vector<accel::BeamPassage> passages = inspector.path(rays, x, y, 0).beams;
    const std::size_t first = paths.first_beam[ray];
    const std::size_t count = paths.first_beam[ray + 1] - first;
    bool equal = count == passages.size();
    for (std::size_t i = 0; equal && i < count; ++i) {
      equal = beams[paths.beam[first + i]].kind == passages[i].kind &&
              (passages[i].kind == accel::BeamKind::kLeaving ||
               paths.places[paths.beam_place[first + i]].index == passages[i].node);
    }
    same += equal ? 1 : 0;
    if (count == 0) continue;
    const accel::BeamKind last = beams[paths.beam[first + count - 1]].kind;
    if (last == accel::BeamKind::kLeaving) {
      EXPECT_EQ(paths.first_step[ray], paths.first_step[ray + 1]) << "without a ray";
    }
  }
  // A sample on the common edge of two beams may be in either.
  EXPECT_GE(same, rays.count() * 98 / 100);
}

TEST(Paths, StoreEachPlaceOnceAndHaveABoxForIt) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const accel::PrimaryRays rays = small_image(scene).rays();
  for (const char* name : {"samet", "tile-beam", "sah-bvh"}) {
    const PathTable paths = follow_image(*chosen(name).front().build(scene), rays, {}, ignore);
    EXPECT_LT(paths.places.size(), paths.place.size()) << name;
    for (const Place& place : paths.places) EXPECT_TRUE(place.has_box) << name;
    for (const std::uint32_t place : paths.place) EXPECT_LT(place, paths.places.size()) << name;
  }
}

TEST(Paths, OmitMissesBeyondTheLimitAndCountThem) {
  const scenes::Scene scene = scenes::load_scene("soup:triangles=300");
  const accel::PrimaryRays rays = small_image(scene).rays();
  const PathTable paths =
      follow_image(*chosen("exhaustive").front().build(scene), rays, {}, ignore);
  for (std::size_t ray = 0; ray < rays.count(); ++ray) {
    ASSERT_EQ(paths.first_step[ray + 1] - paths.first_step[ray], 1U);
    const std::uint32_t tests = paths.first_test[ray + 1] - paths.first_test[ray];
    EXPECT_EQ(tests + paths.omitted[ray], 300U);
    EXPECT_LT(tests, 100U);
  }
}

TEST(Explanation, ContainsTheDataOfEachStructure) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const nlohmann::json page = explain(scene, small_image(scene), chosen("beam,tile-beam"));
  const nlohmann::json& beam = page["structures"][0];
  const nlohmann::json& tiles = page["structures"][1];
  EXPECT_EQ(beam["label"], "beam");
  EXPECT_TRUE(beam["beams"].is_object());
  EXPECT_TRUE(beam["tiles"].is_null());
  EXPECT_GT(beam["paths"]["beam"]["count"], 0);
  EXPECT_TRUE(tiles["beams"].is_null());
  EXPECT_TRUE(tiles["tiles"].is_object());
  EXPECT_FALSE(tiles["pencils"].empty());
}

// The page works for every structure, including those without an inspector.
TEST(Explanation, WorksForEveryStructure) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    const auto choices = chosen(info.name);
    EXPECT_EQ(explain(scene, small_image(scene), choices)["structures"].size(), 1U) << info.name;
  }
}

TEST(Explanation, RefusesLargeImagesAndManyStructures) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const auto large = rays::image_of(scene.cameras.front(), rays::Resolution{1000, 1000}, 1);
  EXPECT_THROW(explain(scene, large, chosen("samet")), InputError);
  EXPECT_THROW(explain(scene, small_image(scene), chosen("samet,beam,kd-tree")), InputError);
  EXPECT_THROW(explain(scene, small_image(scene), {}), InputError);
}

TEST(ExplainPage, HoldsDataThatLooksLikeHtml) {
  try {
    const std::string page = explain_page({{"scene", "</script><script>alert(1)</script>@THREE@"}});
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
    EXPECT_NE(page.find("\\u003c/script>"), std::string::npos);
    EXPECT_NE(page.find("@THREE@"), std::string::npos)
        << "placeholders in the data are not replaced";
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
}

}  // namespace
}  // namespace beambench::explain
