#pragma once
// The result of a ray-triangle test in the versions of madmann91/bvh.

#include <tuple>
#include <utility>

namespace adapters {

/// Ends `ray` at the hit returned by a triangle's `intersect(ray)`. Since the library's commit
/// fbdc596 (February 2025), it returns t and the barycentric coordinates and does not change the
/// ray; before, it returned only the coordinates and stored t in the ray.
template <class Ray, class... Numbers>
void end_at(Ray& ray, const std::tuple<Numbers...>& t_u_v) {
  static_assert(sizeof...(Numbers) == 3, "expected t, u and v: the library has changed");
  ray.tmax = std::get<0>(t_u_v);
}
template <class Ray, class Number>
void end_at(Ray&, const std::pair<Number, Number>&) {}

}  // namespace adapters
