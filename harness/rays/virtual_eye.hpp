#pragma once
// Virtual eyes, from which rays reflected by planar mirrors appear to come.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/planar_mirrors.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Planar surfaces of a scene by primitive.
class PlaneTable {
 public:
  PlaneTable(const scenes::Scene& scene, std::vector<scenes::PlanarSurface> planes);

  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// Returns the index of the surface that a primitive is part of; kNone if it is not part of one.
  std::uint32_t plane_of(scenes::PrimitiveId primitive) const {
    return planes_.empty() ? kNone : plane_of_[primitive];
  }
  const std::vector<scenes::PlanarSurface>& planes() const { return planes_; }

 private:
  std::vector<scenes::PlanarSurface> planes_;
  std::vector<std::uint32_t> plane_of_;  ///< by primitive; empty without planes
};

/// A scene's planar mirrors by primitive.
class MirrorTable : public PlaneTable {
 public:
  explicit MirrorTable(const scenes::Scene& scene)
      : PlaneTable(scene, scenes::planar_mirrors(scene)) {}

  /// Returns the distance from the surface at which rays begin on a primitive that a ray from
  /// `origin` met at `point`; it is the same for all points of a planar mirror.
  double lift_at(scenes::PrimitiveId primitive, const glm::dvec3& origin,
                 const glm::dvec3& point) const {
    const std::uint32_t mirror = plane_of(primitive);
    return mirror == kNone ? accel::surface_lift(origin, point)
                           : accel::mirror_lift(planes()[mirror].bounds);
  }
};

/// The eye of an image, or its mirror image.
struct VirtualEye {
  explicit VirtualEye(accel::PrimaryRays image) : place(image.eye()), view(std::move(image)) {}

  /// Returns the eye of the rays that a mirror reflects. They begin slightly beside the mirror, so
  /// their lines pass through the eye's mirror image, moved by the same distance
  /// (`accel::mirror_lift`). Returns nothing for a mirror seen edge-on, because rounding decides on
  /// which side a ray meets it.
  std::optional<VirtualEye> behind(const scenes::PlanarSurface& mirror) const;

  glm::dvec3 place;
  /// The image seen from this eye, up to rounding: the view's own eye is stored in float, and is
  /// not moved by the lift.
  accel::PrimaryRays view;
};

}  // namespace beambench::rays
