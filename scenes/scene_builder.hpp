#pragma once
// The door every scene comes in by: rounds to float once and refuses what no kernel may see.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// No coordinate, radius or factor of a scene may be larger than this in size.
inline constexpr double kLargestNumber = 1e9;

/// How often a builder set something right instead of refusing it.
struct Repairs {
  std::size_t merged_corners = 0;    ///< of polygons: at the place of the corner before
  std::size_t replaced_normals = 0;  ///< of length 0, by the polygon's own
};

/// Collects primitives into a `Scene`. Each add_* rounds its numbers to float, checks them and
/// throws `InputError` naming the primitive (by kind and the id it would have had) when a number is
/// NaN, infinite or beyond 1e9 in size, or the primitive is degenerate. Callers that know a file
/// and line put them in front of the message.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name);

  /// Primitives added from now on have this surface. The first default is a white matte one.
  void set_surface(const Surface& surface);
  void set_background(const glm::dvec3& color);
  void add_light(const glm::dvec3& position, const glm::dvec3& color = glm::dvec3(1.0));
  /// Throws when the angle is not in (0, 180), from == at, up is parallel to the view, or the
  /// resolution is not from 1x1 to 65535x65535, or the name is not one line of text without '#' and
  /// without blanks at its ends.
  void add_camera(const Camera& camera);

  /// A negative radius means seen from the inside only; 0 is refused.
  void add_sphere(const glm::dvec3& center, double radius);
  /// Both radii negative: seen from the inside only. Radii of mixed sign, both 0, or base == apex
  /// are refused.
  void add_cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                double apex_radius);

  /// Adds a vertex that polygons can share; returns its index.
  std::uint32_t add_vertex(const glm::dvec3& position);
  /// A polygon over shared vertices. `normals` is empty (flat) or one per corner; a normal of
  /// length 0 is replaced by the polygon's own. Consecutive corners at the same place are merged; a
  /// polygon with fewer than three distinct corners, or with no area, is refused.
  void add_polygon(std::span<const std::uint32_t> vertices,
                   std::span<const glm::dvec3> normals = {});
  /// The same with vertices of its own. A refused primitive leaves the builder as it was.
  void add_polygon(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals = {});

  std::size_t primitive_count() const { return scene_.primitives.size(); }
  const Repairs& repairs() const { return repairs_; }

  /// The finished scene. Throws when its box is smaller than `kMinExtent`. Without a camera, one
  /// is fitted to the bounds: from (1, 0.8, 1.3), up +z as in most NFF files, angle 45, the whole
  /// scene in view as far as the eye can be moved back within the limit of coordinates.
  Scene build() &&;

 private:
  std::uint32_t current_surface();
  void add_primitive(PrimitiveKind kind, std::size_t index);
  /// The way of nearly all polygons of large scenes, without allocations. False, and nothing
  /// happens, when something is wrong with the triangle.
  bool add_flat_triangle(std::span<const std::uint32_t> vertices);

  Scene scene_;
  Surface surface_;
  std::optional<std::uint32_t> surface_index_;  ///< of surface_, once a primitive has it
  Repairs repairs_;
};

}  // namespace beambench::scenes
