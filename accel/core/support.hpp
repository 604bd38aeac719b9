#pragma once
// The rays and primitives that a structure supports.

#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// The ray sources and the kinds of primitives that a structure supports. If a requested one is not
/// supported, records have the verdict `unsupported`, without a time or an error.
struct Support {
  bool single_rays = true;
  bool images = true;
  bool batches = true;
  bool spheres = true;
  bool cones = true;
  bool polygons = true;

  /// Returns whether the structure supports every kind of primitive in the scene.
  bool includes(const scenes::Scene& scene) const {
    return (spheres || scene.spheres.empty()) && (cones || scene.cones.empty()) &&
           (polygons || scene.polygons.empty());
  }

  friend bool operator==(const Support&, const Support&) = default;
};

/// Thrown if a structure does not support its input (`Support`).
class UnsupportedError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace beambench::accel
