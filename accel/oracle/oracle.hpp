#pragma once
// The oracle: Embree with exact intersectors.

#include <memory>
#include <optional>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::oracle {

/// A hit whose t has not been rounded to float.
struct ExactHit {
  double t;
  scenes::PrimitiveId primitive;
};

/// Embree's BVH over user geometry whose intersectors compute in double and share no code with the
/// classic structures. Bounds are padded by 4 x 2^-23 x (largest |coordinate| + reach): unpadded,
/// Embree's float boxes lost 6% of the rays aimed at the vertices of a closed mesh. Queries are
/// const and safe from several threads.
///
/// Among hits with equal *double* t, the lowest primitive id wins, while structures compare t
/// rounded to float. At an edge, the oracle and a structure may therefore return different
/// primitives at one point, which the differ classifies as a tie.
class Oracle {
 public:
  /// `reach`: the largest distance between a ray's origin and the coordinate origin.
  Oracle(const scenes::Scene& scene, double reach);
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;
  ~Oracle();

  /// Rays must pass `require_valid`.
  std::optional<ExactHit> closest_hit(const Ray& ray) const;
  bool any_hit(const Ray& ray) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beambench::accel::oracle
