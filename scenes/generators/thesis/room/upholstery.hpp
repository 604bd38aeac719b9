#pragma once
// The sofa and the armchair of `habitacion`.

#include "scenes/modelling/implicit_surface.hpp"

namespace beambench::scenes::generators {

/// A seat with arms, a back and loose cushions, standing at the origin and facing -y: 0.92 deep
/// (y from -0.48 to 0.44), 0.9 high.
struct Settee {
  double width;
  int places;
};
double settee_field(const glm::dvec3& place, const Settee& settee);

/// Its surface in triangles, without what looks down to the floor.
modelling::PolygonMesh settee(const Settee& settee, double cell);
/// Four turned feet.
modelling::PolygonMesh settee_feet(const Settee& settee);

/// A cushion of a half width and height that lies flat around the origin, pointed at its corners.
modelling::PolygonMesh scatter_cushion(double half, double height, int steps);

}  // namespace beambench::scenes::generators
