#pragma once
// The part of contact.hpp that is about cones.

#include "harness/differ/contact.hpp"
#include "harness/differ/ray_line.hpp"
#include "scenes/primitive.hpp"

namespace beambench {

Contact cone_contact(const RayLine& line, const glm::dvec3& point, const Cone& cone,
                     double grazing);
double cone_boundary_distance(const RayLine& line, const Cone& cone);

}  // namespace beambench
