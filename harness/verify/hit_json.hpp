#pragma once
// Formats rays and hits as JSON, the same in every report.

#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

#include "accel/core/ray.hpp"

namespace beambench::verify {

/// Returns null for a miss.
template <class AnyHit>
nlohmann::ordered_json hit_json(const std::optional<AnyHit>& hit) {
  if (!hit) return nullptr;
  return {{"primitive", hit->primitive}, {"t", hit->t}};
}

template <class Vector>
nlohmann::ordered_json vector_json(const Vector& v) {
  return nlohmann::ordered_json::array({v.x, v.y, v.z});
}

/// An infinite t_max, which JSON cannot represent as a number, is null.
inline nlohmann::ordered_json ray_json(const accel::Ray& ray) {
  return {{"origin", vector_json(ray.origin)},
          {"direction", vector_json(ray.direction)},
          {"t_min", ray.t_min},
          {"t_max",
           std::isinf(ray.t_max) ? nlohmann::ordered_json() : nlohmann::ordered_json(ray.t_max)}};
}

}  // namespace beambench::verify
