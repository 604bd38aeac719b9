#pragma once
// How madmann91/bvh reports where a ray hits a triangle, in its versions.

#include <tuple>
#include <utility>

namespace adapters {

/// Ends `ray` at the hit that a triangle's `intersect(ray)` returned. Since the library's commit
/// fbdc596 (February 2025) it returns t and the barycentric coordinates and leaves the ray; before,
/// it returned the coordinates alone and had stored t in the ray.
template <class Ray, class... Numbers>
void end_at(Ray& ray, const std::tuple<Numbers...>& t_u_v) {
  static_assert(sizeof...(Numbers) == 3, "expected t, u and v: the library has changed");
  ray.tmax = std::get<0>(t_u_v);
}
template <class Ray, class Number>
void end_at(Ray&, const std::pair<Number, Number>&) {}

}  // namespace adapters
