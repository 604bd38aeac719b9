#pragma once
// The part of contact.hpp that is about cones.

#include "harness/differ/contact.hpp"
#include "harness/differ/line.hpp"
#include "scenes/primitive.hpp"

namespace beambench {

Contact cone_contact(const Line& line, const glm::dvec3& point, const Cone& cone, double grazing);
double cone_boundary_distance(const Line& line, const Cone& cone);

}  // namespace beambench
