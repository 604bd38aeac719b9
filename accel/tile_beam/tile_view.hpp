#pragma once
// The samples of a raster within one tile of the screen: a beam, and its projection of points.

#include <glm/vec3.hpp>

#include "accel/tile_beam/sample_raster.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::tile_beam {

/// The sides of a tile, in samples.
inline constexpr int kTileWidth = 128;
inline constexpr int kTileHeight = 128;

/// The distance by which triangle edges computed in double are moved outward, in units of
/// |direction|: more than the error of edges computed in float, so that no gap remains between
/// edges of the two kinds.
inline constexpr double kEdgeWidening = 0x1.8p-22;

/// The linear function x * i + y * j + constant at sample (i, j) of a tile.
struct TileLine {
  float x;
  float y;
  float constant;
};

/// A raster's camera: projects points to the screen, in double. A point p relative to the eye has
/// the view depth w = depth . p and lies on the screen at sample (x . p / w, y . p / w).
struct RasterView {
  RasterView(const SampleRaster& raster, const PrimaryRays& rays, const scenes::Bounds& scene);

  glm::vec3 eye;
  glm::dvec3 x;
  glm::dvec3 y;
  glm::dvec3 depth;
  glm::dvec3 origin;  ///< the direction of sample (i, j) is origin + right * i + down * j
  glm::dvec3 right;
  glm::dvec3 down;
  double per_angle_x;  ///< samples per unit of |direction|
  double per_angle_y;
  bool mirrored;       ///< clockwise corners appear counter-clockwise
  double reach = 0.0;  ///< maximum distance of scene points from the eye along any axis
};

/// The view with a tile's first sample as (0, 0), in float. Let e = 2^-24. Coordinates of points
/// relative to the eye have the relative error e, and the errors of x . p, y . p, depth . p are
/// less than 4 e |p| x the length of their row.
struct TileView {
  TileView(const RasterView& raster, int left, int top, int width, int height);

  int left;
  int top;
  int width;  ///< at most kTileWidth; less at the raster's ends
  int height;
  glm::vec3 eye;
  glm::vec3 x;
  glm::vec3 y;
  glm::vec3 depth;
  glm::dvec3 exact_x;  ///< the rows before rounding
  glm::dvec3 exact_y;
  glm::dvec3 exact_depth;
  glm::vec3 origin;  ///< direction of sample (0, 0)
  glm::vec3 right;
  glm::vec3 down;
  bool mirrored;  ///< as `RasterView::mirrored`

  /// The distance from the tile's first sample beyond which corners make their triangles' float
  /// edge functions too inaccurate, in samples per unit of |direction|.
  float guard;
  /// The distance by which boxes of triangles are widened, in samples: only slightly more than the
  /// error of edges evaluated in float, because the boxes must cut off acute corners.
  float box_slack;
  /// If a triangle's float area is below sliver x (longer side of its box)^3, its plane is too
  /// coarse in float.
  float sliver;
  double per_angle_x;  ///< samples per unit of |direction|
  double per_angle_y;
  /// The error bounds of box tests, as distances: for x . p and y . p, and for depth . p.
  float slack_x;
  float slack_y;
  float slack_depth;
};

}  // namespace beambench::accel::tile_beam
