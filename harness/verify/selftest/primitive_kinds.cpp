#include "harness/verify/selftest/primitive_kinds.hpp"

#include <exception>

#include "harness/verify/selftest/awkward_scenes.hpp"
#include "scenes/core/error.hpp"

namespace beambench::verify {
namespace {

/// Whatever else goes wrong is for the checks to tell.
bool refuses(const accel::StructureChoice& choice, const scenes::Scene& scene) {
  try {
    choice.build(scene);
  } catch (const InputError&) {
    return true;
  } catch (const std::exception&) {
  }
  return false;
}

}  // namespace

bool PrimitiveKinds::include(scenes::PrimitiveKind kind) const {
  switch (kind) {
    case scenes::PrimitiveKind::kSphere:
      return spheres;
    case scenes::PrimitiveKind::kCone:
      return cones;
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  return polygons;
}

bool PrimitiveKinds::include(const scenes::Scene& scene) const {
  return (spheres || scene.spheres.empty()) && (cones || scene.cones.empty()) &&
         (polygons || scene.polygons.empty());
}

std::vector<std::string> PrimitiveKinds::names() const {
  std::vector<std::string> names;
  if (spheres) names.emplace_back("spheres");
  if (cones) names.emplace_back("cones");
  if (polygons) names.emplace_back("polygons");
  return names;
}

PrimitiveKinds kinds_taken(const accel::StructureChoice& choice) {
  PrimitiveKinds kinds;
  for (const scenes::Scene& scene : smallest_scenes()) {
    if (scene.primitives.empty() || !refuses(choice, scene)) continue;
    if (!scene.spheres.empty()) kinds.spheres = false;
    if (!scene.cones.empty()) kinds.cones = false;
    if (!scene.polygons.empty()) kinds.polygons = false;
  }
  return kinds.none() ? PrimitiveKinds{} : kinds;
}

}  // namespace beambench::verify
