// Splits that divide primitives: the invariants of the hierarchy, and its savings.

#include "accel/bvh/spatial_builder.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// A hierarchy built over a scene by either builder.
struct Built {
  explicit Built(const scenes::Scene& scene)
      : pieces(bvh::collect_parts(scene)),
        spatial(bvh::build_spatial_bvh(scene, pieces, overlap_tolerance(scene), {})) {
    std::vector<scenes::Bounds> boxes;
    for (const bvh::PrimitivePart& piece : pieces) {
      boxes.push_back(padded(bvh::part_bounds(scene, piece), overlap_tolerance(scene)));
    }
    binned = bvh::build_bvh(boxes, {});
  }

  std::vector<bvh::PrimitivePart> pieces;
  bvh::BinaryBvh spatial;
  bvh::BinaryBvh binned;
};

bool holds(const scenes::Bounds& box, const glm::dvec3& point) {
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.lower[axis] || point[axis] > box.upper[axis]) return false;
  }
  return true;
}

bool holds(const scenes::Bounds& outer, const scenes::Bounds& inner) {
  return united(outer, inner).lower == outer.lower && united(outer, inner).upper == outer.upper;
}

/// Returns triangles of a tenth of the scene's size, and as thin as a hundredth.
scenes::Scene long_triangles(std::uint64_t seed) {
  scenes::SceneBuilder builder("long triangles");
  Random random(seed);
  const auto point = [&] {
    return glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 a = point();
    const glm::dvec3 b = a + point() * 0.3;
    builder.add_polygon(std::array<glm::dvec3, 3>{a, b, b + point() * 0.01});
  }
  return std::move(builder).build();
}

double spatial_over_binned(const char* name) {
  const Built built(scenes::load_scene(name));
  return bvh::sah_cost(built.spatial, {}) / bvh::sah_cost(built.binned, {});
}

using LeavesOfPieces = std::vector<std::vector<const bvh::BvhNode*>>;

LeavesOfPieces leaves_of_pieces(const Built& built) {
  LeavesOfPieces leaves(built.pieces.size());
  for (const bvh::BvhNode& node : built.spatial.nodes) {
    for (std::uint32_t i = 0; i < node.count; ++i) {
      leaves[built.spatial.items[node.first + i]].push_back(&node);
    }
  }
  return leaves;
}

bool holds(const std::vector<const bvh::BvhNode*>& leaves, const glm::dvec3& point) {
  return std::any_of(leaves.begin(), leaves.end(),
                     [&](const bvh::BvhNode* leaf) { return holds(leaf->box, point); });
}

glm::dvec3 random_direction(Random& random) {
  glm::dvec3 direction(0.0);
  while (glm::length(direction) < 0.1) {
    direction = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  return glm::normalize(direction);
}

TEST(SpatialBuilder, EachPointOfATriangleIsInALeafThatRefersToIt) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const scenes::Scene scene = long_triangles(seed);
    const Built built(scene);
    const LeavesOfPieces leaves = leaves_of_pieces(built);
    EXPECT_GT(built.spatial.items.size(), built.pieces.size()) << "no triangle is divided";
    Random random(seed);
    for (std::size_t item = 0; item < built.pieces.size(); ++item) {
      const auto& corner = scene.triangles[built.pieces[item].index].vertex;
      for (int i = 0; i < 40; ++i) {
        double u = random.unit();
        double v = random.unit() * 1.2 - 0.1;  // also on edges
        v = std::clamp(v, 0.0, 1.0 - u);
        const glm::dvec3 point = (1 - u - v) * glm::dvec3(scene.vertices[corner[0]]) +
                                 u * glm::dvec3(scene.vertices[corner[1]]) +
                                 v * glm::dvec3(scene.vertices[corner[2]]);
        ASSERT_TRUE(holds(leaves[item], point)) << "triangle " << item;
      }
    }
  }
}

// The primitives are so crowded that some (23 here) are divided.
TEST(SpatialBuilder, EachPointOfASphereOrConeIsInALeafThatRefersToIt) {
  scenes::SceneBuilder builder("round");
  Random random(7);
  for (int i = 0; i < 600; ++i) {
    const glm::dvec3 center = random_direction(random) * random.unit();
    if (i % 2 == 0) {
      builder.add_sphere(center, random.uniform(0.01, i % 8 == 0 ? 0.5 : 0.05));
    } else {
      builder.add_cone(center, random.uniform(0.0, 0.02),
                       center + random_direction(random) * random.uniform(0.5, 2.0), 0.01);
    }
  }
  const scenes::Scene scene = std::move(builder).build();
  const Built built(scene);
  EXPECT_GT(built.spatial.items.size(), built.pieces.size()) << "nothing is divided";
  const LeavesOfPieces leaves = leaves_of_pieces(built);
  for (std::size_t item = 0; item < built.pieces.size(); ++item) {
    const bvh::PrimitivePart& piece = built.pieces[item];
    const bool is_sphere = scene.primitives[piece.primitive].kind == scenes::PrimitiveKind::kSphere;
    for (int i = 0; i < 100; ++i) {
      const glm::dvec3 direction = random_direction(random);
      glm::dvec3 point;
      if (is_sphere) {
        const scenes::Sphere& sphere = scene.spheres[piece.index];
        point = glm::dvec3(sphere.center) + direction * double{sphere.radius};
      } else {
        const scenes::Cone& cone = scene.cones[piece.index];
        const glm::dvec3 base(cone.base);
        const glm::dvec3 axis = glm::dvec3(cone.apex) - base;
        const double along = random.unit();
        const glm::dvec3 across = glm::normalize(glm::cross(axis, direction));
        point = base + axis * along +
                across * glm::mix(double{cone.base_radius}, double{cone.apex_radius}, along);
      }
      ASSERT_TRUE(holds(leaves[item], point)) << "primitive " << piece.primitive;
    }
  }
}

TEST(SpatialBuilder, IsAHierarchyOfBoundedSize) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(2 + 10 * seed));
    const Built built(scene);
    const bvh::BinaryBvh& bvh = built.spatial;
    EXPECT_LE(bvh.items.size(), 2 * built.pieces.size());
    EXPECT_LE(bvh.depth, bvh::kMaxBvhDepth);
    const std::set<std::uint32_t> used(bvh.items.begin(), bvh.items.end());
    EXPECT_EQ(used.size(), built.pieces.size()) << "a piece is in no leaf";
    for (const bvh::BvhNode& node : bvh.nodes) {
      if (node.is_leaf()) {
        EXPECT_LE(node.count, bvh::BvhOptions{}.max_leaf);
        const auto first = bvh.items.begin() + node.first;
        EXPECT_EQ(std::set<std::uint32_t>(first, first + node.count).size(), node.count)
            << "a leaf refers twice to a piece";
      } else {
        EXPECT_TRUE(holds(node.box, bvh.nodes[node.first].box));
        EXPECT_TRUE(holds(node.box, bvh.nodes[node.first + 1].box));
      }
    }
  }
}

TEST(SpatialBuilder, CostsLess) {
  EXPECT_LT(spatial_over_binned("ajedrez"), 0.85) << "pieces beside the squares of a board";
  EXPECT_LT(spatial_over_binned("torre-eiffel"), 0.93) << "a lattice of long triangles";
  EXPECT_LT(spatial_over_binned("bumpy:triangles=5000"), 1.005) << "there is little to gain";
}

// Triangles that do not overlap are never worth dividing.
TEST(SpatialBuilder, DividesNothingWithoutNeed) {
  scenes::SceneBuilder builder("apart");
  for (int i = 0; i < 64; ++i) {
    const glm::dvec3 a(3 * (i % 4), 3 * (i / 4 % 4), 3 * (i / 16));
    builder.add_polygon(
        std::array<glm::dvec3, 3>{a, a + glm::dvec3(1, 0, 0), a + glm::dvec3(0, 1, 0.5)});
  }
  const Built built(std::move(builder).build());
  EXPECT_EQ(built.spatial.items.size(), built.pieces.size());
  EXPECT_EQ(bvh::sah_cost(built.spatial, {}), bvh::sah_cost(built.binned, {}));
}

TEST(SpatialBuilder, NoPiecesYieldNoNodes) {
  const scenes::Scene scene = tests::random_scene(1, 5);
  EXPECT_TRUE(bvh::build_spatial_bvh(scene, {}, 0.0, {}).nodes.empty());
}

}  // namespace
}  // namespace beambench::accel
