#pragma once
// Builds scenes: rounds to float once and refuses invalid numbers and degenerate primitives.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "scenes/base/error.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Thrown by `SceneBuilder` for a primitive that no ray could hit although its numbers are valid: a
/// sphere of radius 0, a cone without length or with both radii 0, a polygon without area or with
/// fewer than three distinct corners. The builder is unchanged; a reader may skip the primitive.
class DegeneratePrimitive : public InputError {
 public:
  using InputError::InputError;
};

/// The maximum absolute value of a scene's coordinates, radii and factors.
inline constexpr double kLargestNumber = 1e9;

/// Counts of faults that a builder repaired instead of refusing the primitive.
struct Repairs {
  std::size_t merged_corners = 0;    ///< polygon corners at the place of the preceding corner
  std::size_t replaced_normals = 0;  ///< normals of length 0, replaced by the polygon's own
};

/// Collects primitives into a `Scene`. Each add_* rounds its numbers to float, checks them and
/// throws an `InputError` that names the primitive (by kind and the id it would have had) if a
/// number is NaN, infinite or beyond 1e9 in absolute value, or the primitive is degenerate. Callers
/// that read a file put its name and line in front of the message.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::string_view name);

  /// Sets the surface of primitives added from now on. The default is matte white.
  void set_surface(const Surface& surface);
  void set_background(const glm::dvec3& color);
  void add_light(const glm::dvec3& position, const glm::dvec3& color = glm::dvec3(1.0));
  /// Throws if the angle is not in (0, 180), from == at, up is parallel to the view, the resolution
  /// is not from 1x1 to 65535x65535, or the name is not one line of text without '#' and without
  /// blanks at its ends. The scene stores the name in the form of `printable`.
  void add_camera(const Camera& camera);

  /// Adds a sphere. A negative radius makes it visible only from the inside; 0 is refused.
  void add_sphere(const glm::dvec3& center, double radius);
  /// Adds a cone. Two negative radii make it visible only from the inside. Radii of mixed sign, two
  /// radii of 0, and base == apex are refused.
  void add_cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                double apex_radius);

  /// Reserves memory for additional vertices and flat triangles.
  void reserve_triangles(std::size_t vertices, std::size_t triangles);
  /// Adds a vertex that polygons can share, and returns its index.
  std::uint32_t add_vertex(const glm::dvec3& position);
  /// Adds a polygon over shared vertices. `normals` is empty (flat) or has one normal per corner; a
  /// normal of length 0 is replaced by the polygon's own. Consecutive corners at the same place are
  /// merged; a polygon with fewer than three distinct corners, or with no area, is refused.
  void add_polygon(std::span<const std::uint32_t> vertices,
                   std::span<const glm::dvec3> normals = {});
  /// Adds a polygon with its own vertices. A refused primitive leaves the builder unchanged.
  void add_polygon(std::span<const glm::dvec3> vertices, std::span<const glm::dvec3> normals = {});

  std::size_t primitive_count() const { return scene_.primitives.size(); }
  const Repairs& repairs() const { return repairs_; }

  /// Returns the finished scene. Throws if its box is smaller than `kMinExtent`. Without a camera,
  /// one is fitted to the bounds: it looks from (1, 0.8, 1.3), with up +z as in most NFF files and
  /// an angle of 45 degrees. The whole scene is in view unless the limit of coordinates keeps the
  /// eye too close.
  Scene build() &&;

 private:
  std::uint32_t current_surface();
  void add_primitive(PrimitiveKind kind, std::size_t index);
  /// Adds a flat triangle without allocations. Returns false, without adding anything, if the
  /// triangle is not valid.
  bool add_flat_triangle(std::span<const std::uint32_t> vertices);

  Scene scene_;
  Surface surface_;
  std::optional<std::uint32_t> surface_index_;  ///< index of surface_ once a primitive uses it
  Repairs repairs_;
};

/// The smallest diagonal of a scene's box. Rounding is relative, so a scene may have any size for
/// which products of its lengths stay in the range of float. By experiment (`finishes`, triangles,
/// spheres and cones, scaled down), everything is correct at diagonals of 3e-12; Embree loses
/// triangles at 3e-13 and below, and cones, spheres, tile beams and the boxes of sah-bvh fail
/// between 1e-18 and 1e-21. The limit leaves a safety factor of a thousand.
inline constexpr double kMinExtent = 1e-9;

/// Returns why a scene with these bounds is too small, as a clause that includes the remedy, or an
/// empty string if it is large enough or has no primitives.
std::string extent_fault(const Bounds& bounds);

}  // namespace beambench::scenes
