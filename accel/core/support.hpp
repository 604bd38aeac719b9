#pragma once
// What a structure can do at all.

#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// The ray sources and the kinds of primitives that a structure takes. Where it takes less than is
/// wanted, records have the verdict `unsupported`: neither a time nor an error.
struct Support {
  bool single_rays = true;
  bool images = true;
  bool batches = true;
  bool spheres = true;
  bool cones = true;
  bool polygons = true;

  /// Does it take each kind of primitive that the scene has?
  bool includes(const scenes::Scene& scene) const {
    return (spheres || scene.spheres.empty()) && (cones || scene.cones.empty()) &&
           (polygons || scene.polygons.empty());
  }

  friend bool operator==(const Support&, const Support&) = default;
};

/// Thrown where a structure does not take what it is given (`Support`).
class UnsupportedError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace beambench::accel
