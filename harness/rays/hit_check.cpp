#include "harness/rays/hit_check.hpp"

#include <fmt/format.h>

namespace beambench::rays {
namespace {

std::string described(const accel::StructureChoice& choice) {
  const std::string structure = fmt::format("structure '{}'", choice.short_label());
  const std::string& file = choice.info().origin;
  return file.empty() ? structure : fmt::format("the plug-in {}: {}", file, structure);
}

}  // namespace

HitCheck::HitCheck(const scenes::Scene& scene, const accel::StructureChoice& choice)
    : HitCheck(scene, described(choice)) {}

std::string HitCheck::pixel_text(int x, int y, int sample) {
  return fmt::format("at pixel ({}, {}) sample {}, ", x, y, sample);
}

void HitCheck::fail(const accel::Ray& ray, const accel::Hit& hit, const std::string& where) const {
  throw InvalidHit(fmt::format(
      "{} returned an invalid hit: primitive {} at t = {}, {}for the ray from ({}, {}, {}) along "
      "({}, {}, {}); expected one of the scene's {} primitives at a finite t in [{}, {}]",
      structure_, hit.primitive, hit.t, where, ray.origin.x, ray.origin.y, ray.origin.z,
      ray.direction.x, ray.direction.y, ray.direction.z, primitives_, ray.t_min, ray.t_max));
}

}  // namespace beambench::rays
