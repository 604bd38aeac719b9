// A one-function ray tracer, and a program that verifies its hits: exit code 0 if all are correct.

#include <cstdio>
#include <string_view>
#include <vector>

#include <beambench/verify.hpp>
#include <glm/geometric.hpp>

using namespace beambench;

/// Returns the t at which the ray hits the triangle, in float; infinity for a miss (Moeller and
/// Trumbore 1997).
float hit_triangle(const accel::Ray& ray, const glm::vec3& a, const glm::vec3& b,
                   const glm::vec3& c) {
  const glm::vec3 ab = b - a, ac = c - a, offset = ray.origin - a;
  const glm::vec3 p = glm::cross(ray.direction, ac), q = glm::cross(offset, ab);
  const float scale = 1.0F / glm::dot(ab, p);
  const float u = glm::dot(offset, p) * scale, v = glm::dot(ray.direction, q) * scale;
  const float t = glm::dot(ac, q) * scale;
  const bool inside = u >= 0.0F && v >= 0.0F && u + v <= 1.0F;
  return inside && t >= ray.t_min && t <= ray.t_max ? t : accel::kInfinity;
}

int main(int argc, char** argv) {
  const std::string_view fault = argc > 1 ? argv[1] : "";
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");  // or made by scenes::SceneBuilder
  const accel::PrimaryRays image(scene.cameras.front(), 80, 60, 1);
  std::vector<accel::Ray> rays;
  image.for_each(0, image.height(),
                 [&](std::size_t, const accel::Ray& ray) { rays.push_back(ray); });

  rays::HitTable hits{.t = std::vector<float>(rays.size(), accel::kInfinity),
                      .primitives = std::vector(rays.size(), scenes::kNoPrimitive)};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (const scenes::Triangle& each : scene.triangles) {
      const float t = hit_triangle(rays[i], scene.vertices[each.vertex[0]],
                                   scene.vertices[each.vertex[1]], scene.vertices[each.vertex[2]]);
      if (t >= hits.t[i]) continue;
      hits.t[i] = t;
      hits.primitives[i] = each.primitive;
    }
  }
  std::size_t broken = rays.size() / 2;
  while (hits.t[broken] == accel::kInfinity) ++broken;
  if (fault == "moved") hits.t[broken] *= 1.001F;
  if (fault == "exchanged") hits.primitives[broken] ^= 1U;
  if (fault == "dropped") hits.t[broken] = accel::kInfinity;
  if (fault == "dropped") hits.primitives[broken] = scenes::kNoPrimitive;

  verify::ClaimVerifier verifier(scene);
  verifier.add(rays, hits.view());
  const verify::DiffReport report = verifier.finish();
  for (std::size_t i = 0; i < verify::kDiffClassNames.size(); ++i) {
    std::printf("%s: %llu\n", verify::kDiffClassNames[i].data(),
                static_cast<unsigned long long>(report.counts[i]));
  }
  for (const verify::Mismatch& each : report.examples) {
    std::printf("%s", verify::describe(scene, each).c_str());
  }
  return report.verdict == verify::Verdict::kOk ? 0 : 1;
}
