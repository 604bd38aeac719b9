#pragma once
// Profiles, drawn piece by piece and revolved about the z axis.

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "scenes/modelling/polygon_mesh.hpp"

namespace beambench::scenes::modelling {

/// A line of points (radius, height), extended piece by piece from its start.
class Profile {
 public:
  explicit Profile(const glm::dvec2& start) : points_{start} {}

  Profile& line(const glm::dvec2& to);
  /// Adds a parabola in `steps` pieces. Its middle is `bulge` to the right of the straight line in
  /// its direction, which is outside for a line that runs upward; a negative bulge is on the other
  /// side.
  Profile& curve(const glm::dvec2& to, double bulge, int steps);
  /// Adds a ball around a place on the axis in `steps` pieces, from the height at which its surface
  /// has the current point's radius to its top. The current point must be at or below the starting
  /// height.
  Profile& ball(double center, double radius, int steps);

  const std::vector<glm::dvec2>& points() const { return points_; }

 private:
  std::vector<glm::dvec2> points_;
};

/// Returns the profile's points (radius, height) revolved in `sides` steps, the first of which is
/// at `first_turn` of a full turn. If the profile is drawn upward, the surface faces outward. Each
/// piece of the profile becomes a ring of flat quads, or of triangles if one end has radius 0; a
/// piece with both ends on the axis is skipped. Ends with a nonzero radius stay open.
PolygonMesh lathe(std::span<const glm::dvec2> profile, int sides, double first_turn = 0.0);

}  // namespace beambench::scenes::modelling
