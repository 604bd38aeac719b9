#pragma once
// A cone for the samples of a tile: an equation whose coefficients are linear on the screen.

#include <array>
#include <optional>

#include "accel/tile_beam/sample_raster.hpp"
#include "accel/tile_beam/tile_view.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::tile_beam {

/// How rays from one eye meet a cone frustum. Lengths are in units of the distance from the eye
/// within which all of the cone lies, so that scenes of any size have the same rounding, and
/// w = 1/t is the unknown. Seen from the frustum's middle, let the eye be at height H along the
/// axis and at the distance X beside it; x be the direction from the axis to the eye, y at right
/// angles to it and to the axis; C and S the cosine and sine of the angle between the surface and
/// the axis. The point of a ray in direction d, multiplied by w, then has
///
///   along x       X w + d.x
///   along y       d.y
///   height        H w + d.axis
///   C x radius    R w + S d.axis         with R that at the height of the eye
///
/// and is on the surface where C^2 (square of the distance from the axis) equals the square of the
/// last, so  c w^2 + 2 b w + a = 0  with a constant c, and b that is linear in the direction.
/// Where the eye is outside the (infinite, double) cone, b^2 - a c is a product of two linear
/// functions: those of the planes through the eye that touch it, which are the lines of its
/// silhouette. Both are positive between these lines, where the radius is positive. Where the eye
/// is inside, b^2 - a c is the sum of the squares of two linear functions.
struct ConeEquation {
  TileLine beside;                ///< C d.x
  TileLine across;                ///< C d.y
  TileLine along;                 ///< d.axis
  TileLine half_linear;           ///< b
  std::array<TileLine, 2> sides;  ///< the factors of b^2 - a c, or what is squared
  float eye_beside;               ///< C X
  float eye_height;               ///< H
  float eye_radius;               ///< R
  float sine;                     ///< S; negative where the apex has the smaller radius
  float half_length;              ///< the frustum reaches from -half_length to half_length
  float inverse_constant;         ///< 1 / c
  float per_length;               ///< 1 / the unit of lengths
  bool outside;                   ///< the eye is, of the double cone
  float least_side;               ///< seen from outside, sides nearer to 0 may have either sign
  float least_root;               ///< where |b| + sqrt(b^2 - a c) is less, w is too inaccurate
};

/// The equation for a tile of a raster. None for the cones that float is too coarse for: flat ones
/// and short ones, and those that the eye touches.
std::optional<ConeEquation> cone_equation(const scenes::Cone& cone, const SampleRaster& raster,
                                          const TileView& view);

}  // namespace beambench::accel::tile_beam
