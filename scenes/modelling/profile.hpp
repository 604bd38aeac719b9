#pragma once
// Profiles for the lathe, drawn piece by piece.

#include <vector>

#include <glm/vec2.hpp>

namespace beambench::scenes::modelling {

/// A line of points (radius, height), drawn from where it starts.
class Profile {
 public:
  explicit Profile(const glm::dvec2& start) : points_{start} {}

  Profile& line(const glm::dvec2& to);
  /// A parabola in `steps` pieces whose middle is `bulge` outside the straight line (to the right
  /// of the way, which walks upward), inside where it is negative.
  Profile& curve(const glm::dvec2& to, double bulge, int steps);
  /// A ball around a place on the axis, from where its surface has the present point's radius to
  /// its top, in `steps` pieces. The present point must be at or below that place.
  Profile& ball(double center, double radius, int steps);

  const std::vector<glm::dvec2>& points() const { return points_; }

 private:
  std::vector<glm::dvec2> points_;
};

}  // namespace beambench::scenes::modelling
