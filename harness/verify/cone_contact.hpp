#pragma once
// The part of contact.hpp that is about cones.

#include "harness/verify/contact.hpp"
#include "harness/verify/ray_line.hpp"
#include "scenes/primitive.hpp"

namespace beambench::verify {

Contact cone_contact(const RayLine& line, const glm::dvec3& point, const scenes::Cone& cone,
                     double grazing);
double cone_boundary_distance(const RayLine& line, const scenes::Cone& cone);

}  // namespace beambench::verify
