#include <algorithm>

#include "accel/core/overlap.hpp"

namespace beambench::accel {

bool sphere_overlaps(const scenes::Sphere& sphere, const Box& box, double tolerance) {
  double nearest = 0.0;   // squared distance from the center to the box
  double farthest = 0.0;  // and to its farthest corner
  for (int axis = 0; axis < 3; ++axis) {
    const double below = box.lower[axis] - sphere.center[axis];
    const double above = sphere.center[axis] - box.upper[axis];
    const double outside = std::max({below, above, 0.0});
    const double across = std::max(-below, -above);
    nearest += outside * outside;
    farthest += across * across;
  }
  const double outer = sphere.radius + tolerance;
  const double inner = std::max(sphere.radius - tolerance, 0.0);
  return nearest <= outer * outer && farthest >= inner * inner;
}

}  // namespace beambench::accel
