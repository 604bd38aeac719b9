#pragma once
// Random scenes and rays for the tests of every module: those of `beambench selftest`.

#include <glm/geometric.hpp>

#include "harness/verify/selftest/test_scenes.hpp"

namespace beambench::tests {

using beambench::verify::random_ray;
using beambench::verify::random_scene;

/// Returns a direction of unit length.
inline glm::dvec3 random_direction(Random& random) {
  return glm::normalize(verify::point_in_cube(random));
}

}  // namespace beambench::tests
