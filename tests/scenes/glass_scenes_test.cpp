// The scenes with planar glass: closed bodies, apart from each other and from opaque primitives.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "scenes/perturbed.hpp"
#include "scenes/planar_mirrors.hpp"

namespace beambench::scenes {
namespace {

using glm::dvec3;

/// A polygon of glass, seen from outside.
struct Face {
  std::vector<std::uint32_t> corners;
  std::vector<dvec3> places;
  dvec3 normal;  ///< outward, unit length
};

bool is_glass(const Scene& scene, const Primitive& primitive) {
  return scene.surfaces[primitive.surface].transmittance > 0.0F;
}

std::vector<std::uint32_t> corners_of(const Scene& scene, const Primitive& primitive) {
  const Polygon& polygon = scene.polygons[primitive.index];
  const auto first = scene.corners.begin() + polygon.first_corner;
  return {first, first + polygon.corner_count};
}

std::vector<Face> glass_faces(const Scene& scene) {
  std::vector<Face> faces;
  for (const Primitive& primitive : scene.primitives) {
    if (!is_glass(scene, primitive)) continue;
    Face& face = faces.emplace_back();
    face.corners = corners_of(scene, primitive);
    for (const std::uint32_t corner : face.corners)
      face.places.emplace_back(scene.vertices[corner]);
    const std::span<const dvec3> p = face.places;
    face.normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  }
  return faces;
}

/// Returns how far inside its edges a point in a convex face's plane is; negative outside.
double depth_inside(const Face& face, const dvec3& point) {
  double depth = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < face.places.size(); ++i) {
    const dvec3 along = glm::normalize(face.places[(i + 1) % face.places.size()] - face.places[i]);
    depth = std::min(depth, glm::dot(glm::cross(face.normal, along), point - face.places[i]));
  }
  return depth;
}

/// Returns whether a segment passes through a convex face or comes within `margin` of it.
bool meets(const Face& face, const dvec3& a, const dvec3& b, double margin) {
  const double from = glm::dot(face.normal, a - face.places[0]);
  const double to = glm::dot(face.normal, b - face.places[0]);
  for (const auto& [distance, end] : {std::pair(from, a), std::pair(to, b)}) {
    if (std::abs(distance) < margin && depth_inside(face, end) > -margin) return true;
  }
  if ((from < 0.0) == (to < 0.0)) return false;
  return depth_inside(face, glm::mix(a, b, from / (from - to))) > -margin;
}

class GlassScenes : public testing::TestWithParam<const char*> {};

TEST_P(GlassScenes, HaveClosedBodiesThatFaceOutward) {
  const std::vector<Face> faces = glass_faces(load_scene(GetParam()));
  ASSERT_FALSE(faces.empty());
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> face_of;  // by edge
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& corners = faces[f].corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::pair edge(corners[i], corners[(i + 1) % corners.size()]);
      ASSERT_TRUE(face_of.emplace(edge, f).second) << "two faces have the same edge";
    }
  }
  for (const auto& [edge, f] : face_of) {
    const auto other = face_of.find({edge.second, edge.first});
    ASSERT_NE(other, face_of.end()) << "an edge belongs to one face only";
    for (const dvec3& place :
         faces[other->second].places) {  // holds for outward faces of a convex body
      EXPECT_LE(glm::dot(faces[f].normal, place - faces[f].places[0]), 1e-6);
    }
  }
}

TEST_P(GlassScenes, ReflectAtEachFaceAsAPlane) {
  const Scene scene = load_scene(GetParam());
  std::size_t polygons = 0;
  for (const PlanarSurface& mirror : planar_mirrors(scene)) polygons += mirror.polygons.size();
  EXPECT_EQ(polygons, glass_faces(scene).size());
  for (const Primitive& primitive : scene.primitives) {
    EXPECT_EQ(scene.polygons[primitive.index].first_normal, Polygon::kFlat);
  }
}

/// Expects that no opaque polygon touches or crosses a face of glass.
void expect_apart(const Scene& scene, double margin) {
  const std::vector<Face> faces = glass_faces(scene);
  for (const Primitive& primitive : scene.primitives) {
    if (is_glass(scene, primitive)) continue;
    const std::vector<std::uint32_t> corners = corners_of(scene, primitive);
    Face opaque{corners, {}, {}};
    for (const std::uint32_t corner : corners) opaque.places.emplace_back(scene.vertices[corner]);
    const std::span<const dvec3> p = opaque.places;
    opaque.normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    for (const Face& face : faces) {
      for (std::size_t i = 0; i < p.size(); ++i) {
        ASSERT_FALSE(meets(face, p[i], p[(i + 1) % p.size()], margin)) << "opaque edge";
      }
      for (std::size_t i = 0; i < face.places.size(); ++i) {
        ASSERT_FALSE(meets(opaque, face.places[i], face.places[(i + 1) % face.places.size()], 0.0))
            << "edge of glass";
      }
    }
  }
}

TEST_P(GlassScenes, KeepOpaquePolygonsOffTheGlass) {
  for (const int detail : {1, 2, 3, 8, 11}) {
    SCOPED_TRACE(detail);
    expect_apart(load_scene(std::string(GetParam()) + ":detail=" + std::to_string(detail)), 0.01);
  }
}

TEST(Aquarium, StaysClosedAndFullWhenPerturbed) {
  const Scene scene = load_scene("aquarium");
  const std::vector<Face> water = glass_faces(scene);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Scene variant = perturbed(scene, seed);
    const std::vector<Face> faces = glass_faces(variant);
    ASSERT_EQ(faces.size(), water.size());
    for (std::size_t f = 0; f < faces.size(); ++f) EXPECT_EQ(faces[f].places, water[f].places);
    expect_apart(variant, 0.0);
  }
}

TEST(Prism, HasTwoBodiesThatStandApart) {
  const std::vector<Face> faces = glass_faces(load_scene("prism"));
  ASSERT_EQ(faces.size(), 11U);
  const std::span<const Face> prism = std::span(faces).first(5);
  const std::span<const Face> plate = std::span(faces).last(6);
  EXPECT_TRUE(std::ranges::any_of(plate, [&](const Face& separating) {
    return std::ranges::all_of(prism, [&](const Face& face) {
      return std::ranges::all_of(face.places, [&](const dvec3& place) {
        return glm::dot(separating.normal, place - separating.places[0]) > 0.1;
      });
    });
  })) << "no face of the plate separates the two bodies";
}

INSTANTIATE_TEST_SUITE_P(Catalogue, GlassScenes, testing::Values("aquarium", "prism"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace beambench::scenes
