#pragma once
// The bird of `flamenco`.

#include "scenes/modelling/implicit_surface.hpp"

namespace beambench::scenes::generators {

/// A flamingo, 1.75 high, that stands at the origin on its left leg and looks to +x.
double flamingo_field(const glm::dvec3& place);

/// What its places are covered with.
enum class Plumage : std::uint8_t { kPink, kWing, kFlightFeathers, kLeg, kBill, kBillTip };
Plumage flamingo_plumage(const glm::dvec3& place);

}  // namespace beambench::scenes::generators
