#pragma once
// The primitives of a scene: sphere, cone, polygon (flat or smooth).

#include <array>
#include <cstdint>

#include <glm/vec3.hpp>

namespace beambench::scenes {

/// Identifies a primitive: its position in `Scene::primitives`.
using PrimitiveId = std::uint32_t;
inline constexpr PrimitiveId kNoPrimitive = 0xFFFFFFFFU;

enum class PrimitiveKind : std::uint32_t { kSphere, kCone, kPolygon };

/// The entry of a primitive id: the kind, the index in the scene's array of that kind, and the
/// index of its surface.
struct Primitive {
  PrimitiveKind kind;
  std::uint32_t index;
  std::uint32_t surface;
};

/// A hollow sphere; radius > 0. `inside_only` (a negative radius in NFF): rays hit it only where
/// they exit.
struct Sphere {
  glm::vec3 center;
  float radius;
  bool inside_only;
};

/// The lateral surface of a cone frustum or cylinder, without caps. Radii are >= 0 and not both 0,
/// and base != apex. `inside_only` (both radii negative in NFF): rays hit it only where they exit.
struct Cone {
  glm::vec3 base;
  float base_radius;
  glm::vec3 apex;
  float apex_radius;
  bool inside_only;
};

/// A simple polygon, convex or concave, visible from both sides. Its surface *is* the union of its
/// triangles (`Scene::triangles[first_triangle ...]`), made once by `triangulate`. All structures,
/// including Embree, use these triangles.
struct Polygon {
  std::uint32_t first_corner;    ///< index into Scene::corners
  std::uint32_t corner_count;    ///< >= 3
  std::uint32_t first_triangle;  ///< index into Scene::triangles
  std::uint32_t triangle_count;  ///< >= 1, at most corner_count - 2
  std::uint32_t first_normal;    ///< index into Scene::normals, one per corner; kFlat if flat

  static constexpr std::uint32_t kFlat = 0xFFFFFFFFU;
};

/// A triangle of a polygon's surface: three indices into Scene::vertices, and the polygon's id.
struct Triangle {
  std::array<std::uint32_t, 3> vertex;
  PrimitiveId primitive;
};

}  // namespace beambench::scenes
