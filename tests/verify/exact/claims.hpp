#pragma once
// Correct and wrong claims about rays, made from the exact crossings.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "accel/core/ray.hpp"
#include "scenes/base/random.hpp"
#include "tests/verify/exact/acceptance.hpp"

namespace beambench::exact {

using ClosestClaim = std::optional<accel::Hit>;

/// Makes the claims about one ray, without deciding which are correct.
class ClaimMaker {
 public:
  ClaimMaker(const Traced& traced, Random& random) : traced_(traced), random_(random) {}

  std::vector<ClosestClaim> closest() {
    claims_ = {std::nullopt};
    std::size_t met = 0;
    for (std::size_t i = 0; i < traced_.crossings.size(); ++i) {
      if (!traced_.inside[i]) continue;
      const Crossing& crossing = traced_.crossings[i];
      if (++met > 3) break;
      add(crossing.at.rounded(), crossing.primitive);
      if (met > 1 && random_.below(2) == 0) continue;
      add(moved(crossing), crossing.primitive);
      if (met == 1) add(moved(crossing), crossing.primitive);
      add(crossing.at.rounded(), any_primitive());  // another primitive at this point
    }
    add_outside();
    add_anywhere();
    return std::move(claims_);
  }

 private:
  scenes::PrimitiveId any_primitive() {
    return static_cast<scenes::PrimitiveId>(random_.below(traced_.solids.size()));
  }
  void add(double parameter, scenes::PrimitiveId primitive) {
    add_t(static_cast<float>(traced_.ray.t_of(parameter)), primitive);
  }
  void add_t(float t, scenes::PrimitiveId primitive) {
    if (std::isfinite(t)) claims_.push_back(accel::Hit{t, primitive});
  }

  /// Returns the crossing's parameter, moved by -100 to 100 times K u across the surface or along
  /// the ray.
  double moved(const Crossing& crossing) {
    const double s = crossing.at.rounded();
    const double unit =
        16.0 * 0x1p-24 *
        (largest(glm::abs(traced_.ray.at(s))) + glm::length(glm::dvec3(traced_.ray.given.origin)));
    const double sign = random_.below(2) == 0 ? -1.0 : 1.0;
    static constexpr std::array<double, 6> kFactors{0.05, 0.15, 0.22, 4.5, 8.0, 100.0};
    const double distance = sign * kFactors[random_.below(kFactors.size())] * unit;
    return s + distance / traced_.ray.speed / (random_.below(3) == 0 ? 1.0 : cosine(crossing));
  }
  /// Returns |cos| of the angle between the ray and the normal, at least 2^-12.
  double cosine(const Crossing& crossing) const {
    const double root = std::sqrt(crossing.at.d.rounded());
    const double across =
        crossing.curved ? crossing.at.w.rounded() * root /
                              (crossing.stretch *
                               (crossing.slack.rounded() + crossing.slack_of_root.rounded() * root))
                        : crossing.at.w.rounded() / crossing.stretch;
    return std::clamp(across / traced_.ray.speed, 0x1p-12, 1.0);
  }

  /// Adds crossings of the line that are not in the interval, both unchanged and moved to its ends.
  void add_outside() {
    const accel::Ray& ray = traced_.ray.given;
    std::size_t added = 0;
    for (std::size_t i = 0; i < traced_.crossings.size() && added < 2; ++i) {
      if (traced_.inside[i]) continue;
      const Crossing& crossing = traced_.crossings[i];
      const bool before = compare(crossing.at, traced_.ray.from.at) < 0;
      add_t(before ? ray.t_min : ray.t_max, crossing.primitive);
      add(crossing.at.rounded(), crossing.primitive);
      ++added;
    }
  }

  void add_anywhere() {
    const accel::Ray& ray = traced_.ray.given;
    add_t(ray.t_min, any_primitive());
    add_t(ray.t_max, any_primitive());
    add(random_.uniform(0.0, 5.0) / traced_.ray.speed, any_primitive());
    // The point where the ray comes closest to the center of a primitive, which it may just miss.
    const scenes::PrimitiveId id = any_primitive();
    const Solid& solid = traced_.solids[id];
    const glm::dvec3 middle = 0.5 * (solid.lower + solid.upper);
    const glm::dvec3 direction = traced_.ray.direction.rounded();
    add(glm::dot(middle - glm::dvec3(ray.origin), direction) / glm::dot(direction, direction), id);
  }

  const Traced& traced_;
  Random& random_;
  std::vector<ClosestClaim> claims_;
};

}  // namespace beambench::exact
