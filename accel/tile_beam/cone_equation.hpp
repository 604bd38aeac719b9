#pragma once
// A cone for the samples of a tile: an equation whose coefficients are linear on the screen.

#include <array>
#include <optional>

#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_view.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::tile_beam {

/// The equation for hits of a cone frustum by rays from one eye. The unit of length is a distance
/// from the eye within which the whole cone lies, so that scenes of any size have the same
/// rounding; w = 1/t is the unknown. Relative to the frustum's middle, let the eye be at height H
/// along the axis and at distance X from it. Let x be the direction from the axis to the eye, and y
/// a direction perpendicular to x and the axis. Let C and S be the cosine and sine of the angle
/// between the surface and the axis. The point of a ray in direction d, multiplied by w, then has
///
///   along x       X w + d.x
///   along y       d.y
///   height        H w + d.axis
///   C x radius    R w + S d.axis         where R is C x radius at the height of the eye
///
/// and is on the surface where C^2 (square of the distance from the axis) equals the square of the
/// last line, so c w^2 + 2 b w + a = 0 with a constant c and with b linear in the direction. If the
/// eye is outside the (infinite, double) cone, b^2 - a c is a product of two linear functions:
/// those of the planes through the eye that touch the cone, the lines of its silhouette. Both are
/// positive between these lines, where the radius is positive. If the eye is inside, b^2 - a c is
/// the sum of the squares of two linear functions.
struct ConeEquation {
  TileLine beside;                ///< C d.x
  TileLine across;                ///< C d.y
  TileLine along;                 ///< d.axis
  TileLine half_linear;           ///< b
  std::array<TileLine, 2> sides;  ///< the factors of b^2 - a c, or the squared functions
  float eye_beside;               ///< C X
  float eye_height;               ///< H
  float eye_radius;               ///< R
  float sine;                     ///< S; negative where the apex has the smaller radius
  float half_length;              ///< the frustum reaches from -half_length to half_length
  float inverse_constant;         ///< 1 / c
  float per_length;               ///< 1 / the unit of lengths
  bool outside;                   ///< whether the eye is outside the double cone
  float least_side;               ///< seen from outside, sides closer to 0 may have either sign
  float least_root;               ///< if |b| + sqrt(b^2 - a c) is less, w is too inaccurate
};

/// Returns the equation for a tile of a raster. Returns nothing for cones for which float is too
/// coarse: flat ones, short ones, and those that the eye touches.
std::optional<ConeEquation> cone_equation(const scenes::Cone& cone, const SampleRaster& raster,
                                          const TileView& view);

}  // namespace beambench::accel::tile_beam
