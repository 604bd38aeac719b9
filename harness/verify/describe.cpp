#include <fmt/format.h>

#include "harness/verify/differ.hpp"

namespace beambench::verify {
namespace {

std::string_view kind_of(const scenes::Scene& scene, scenes::PrimitiveId id) {
  if (id >= scene.primitives.size()) return "not in the scene";
  switch (scene.primitives[id].kind) {
    case scenes::PrimitiveKind::kSphere:
      return "sphere";
    case scenes::PrimitiveKind::kCone:
      return "cone";
    case scenes::PrimitiveKind::kPolygon:
      return "polygon";
  }
  return "unknown";
}

/// Floats and doubles are printed with as many digits as tell them apart from their neighbors.
template <class AnyHit>
std::string text(const scenes::Scene& scene, const std::optional<AnyHit>& hit) {
  if (!hit) return "miss";
  if (hit->primitive == scenes::kNoPrimitive) return fmt::format("miss, but with t = {}", hit->t);
  return fmt::format("primitive {} ({}) at t = {}", hit->primitive, kind_of(scene, hit->primitive),
                     hit->t);
}

std::string text(const glm::vec3& vector) {
  return fmt::format("({}, {}, {})", vector.x, vector.y, vector.z);
}

std::string engine_text(const scenes::Scene& scene, const Mismatch& mismatch) {
  if (mismatch.query == rays::Query::kClosestHit) return text(scene, mismatch.engine);
  if (mismatch.engine_any_hit > 1) return "neither yes nor no";
  return mismatch.engine_any_hit == 1 ? "some hit" : "no hit";
}

}  // namespace

std::string describe(const scenes::Scene& scene, const rays::Question& question,
                     const Mismatch& mismatch) {
  return fmt::format(
      "{}: {}{}{}\n"
      "  ray    from {} along {}, t in [{}, {}]\n"
      "  engine {}\n"
      "  oracle {}\n"
      "  exact  {}\n",
      rays::place_text(question, mismatch.index),
      kDiffClassNames[static_cast<std::size_t>(mismatch.diff_class)],
      mismatch.reason.empty() ? "" : ", ", mismatch.reason, text(mismatch.ray.origin),
      text(mismatch.ray.direction), mismatch.ray.t_min, mismatch.ray.t_max,
      engine_text(scene, mismatch), text(scene, mismatch.oracle),
      mismatch.adjudicated ? text(scene, mismatch.exact) : "not asked");
}

std::string describe(const scenes::Scene& scene, const rays::Question& question,
                     const Mismatch& mismatch, const ReplayCommand& replay) {
  return fmt::format("{}  replay {}\n", describe(scene, question, mismatch),
                     replay.of(mismatch.index));
}

}  // namespace beambench::verify
