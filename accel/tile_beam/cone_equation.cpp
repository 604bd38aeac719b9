#include "accel/tile_beam/cone_equation.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench::accel::tile_beam {
namespace {

/// Surfaces count as flat beyond this cosine of the inclination to the axis.
constexpr double kFlat = 0x1p-5;
/// Shorter cones are left to double precision, because a rim has a doubtful margin of 2^-18 on
/// either side.
constexpr double kShort = 0x1p-12;
/// Below this distance, the eye counts as touching the surface.
constexpr double kTouching = 0x1p-18;

/// Returns a vector perpendicular to a unit vector.
glm::dvec3 beside_axis(const glm::dvec3& axis) {
  const glm::dvec3 size = glm::abs(axis);
  const bool is_x = size.x <= size.y && size.x <= size.z;
  const glm::dvec3 other = is_x               ? glm::dvec3(1.0, 0.0, 0.0)
                           : size.y <= size.z ? glm::dvec3(0.0, 1.0, 0.0)
                                              : glm::dvec3(0.0, 0.0, 1.0);
  return glm::normalize(glm::cross(axis, other));
}

}  // namespace

std::optional<ConeEquation> cone_equation(const scenes::Cone& cone, const SampleRaster& raster,
                                          const TileView& view) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 whole_axis = glm::dvec3(cone.apex) - base;
  const double length_squared = glm::dot(whole_axis, whole_axis);
  const double length = std::sqrt(length_squared);
  const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
  const double slant = std::sqrt(length_squared + taper * taper);
  const double cosine = length / slant;
  if (cosine < kFlat) return std::nullopt;
  const double sine = taper / slant;
  const glm::dvec3 axis = whole_axis / length;

  const glm::dvec3 from_middle = glm::dvec3(view.eye) - (base + 0.5 * whole_axis);
  const double widest = std::max(cone.base_radius, cone.apex_radius);
  const double unit = glm::length(from_middle) + std::sqrt(0.25 * length_squared + widest * widest);
  const double per_length = 1.0 / unit;
  const double half_length = 0.5 * length * per_length;
  if (half_length < kShort) return std::nullopt;

  const glm::dvec3 eye = from_middle * per_length;
  const double eye_height = glm::dot(eye, axis);
  const glm::dvec3 from_axis = eye - axis * eye_height;
  const double distance = glm::length(from_axis);
  const glm::dvec3 x = distance > 0x1p-40 ? from_axis / distance : beside_axis(axis);
  const glm::dvec3 y = glm::cross(axis, x);
  const double middle_radius =
      0.5 * (static_cast<double>(cone.base_radius) + cone.apex_radius) * per_length;
  const double eye_beside = cosine * distance;
  const double eye_radius = cosine * middle_radius + sine * eye_height;
  if (std::abs(eye_beside - std::abs(eye_radius)) <= kTouching &&
      std::abs(eye_height) <= half_length + kTouching) {
    return std::nullopt;
  }
  const double constant = (eye_beside - eye_radius) * (eye_beside + eye_radius);
  if (std::abs(constant) < 0x1p-40) return std::nullopt;  // so close to 0 that its error matters

  const glm::dvec3 corner = raster.origin + raster.right * static_cast<double>(view.left) +
                            raster.down * static_cast<double>(view.top);
  const auto linear = [&](const glm::dvec3& gradient) {
    return TileLine{static_cast<float>(glm::dot(gradient, raster.right)),
                    static_cast<float>(glm::dot(gradient, raster.down)),
                    static_cast<float>(glm::dot(gradient, corner))};
  };
  // b^2 - a c = (C R d.x - S C X d.axis)^2 - c (C d.y)^2, where eye_beside is C X. The root of the
  // first square is positive toward all points with a positive radius.
  const glm::dvec3 toward = sine * eye_beside * axis - cosine * eye_radius * x;
  const glm::dvec3 sideways = cosine * std::sqrt(std::abs(constant)) * y;
  const bool outside = constant > 0.0;

  const glm::dvec3 across = raster.right * static_cast<double>(view.width);
  const glm::dvec3 down = raster.down * static_cast<double>(view.height);
  double longest_squared = 0.0;  // of all directions
  for (const glm::dvec3& direction :
       {corner, corner + across, corner + down, corner + across + down}) {
    longest_squared = std::max(longest_squared, glm::dot(direction, direction));
  }
  const double side =
      std::sqrt((glm::dot(toward, toward) + glm::dot(sideways, sideways)) * longest_squared);

  ConeEquation equation{};
  equation.beside = linear(cosine * x);
  equation.across = linear(cosine * y);
  equation.along = linear(axis);
  equation.half_linear = linear(cosine * eye_beside * x - sine * eye_radius * axis);
  equation.sides = {linear(outside ? toward - sideways : toward),
                    linear(outside ? toward + sideways : sideways)};
  equation.eye_beside = static_cast<float>(eye_beside);
  equation.eye_height = static_cast<float>(eye_height);
  equation.eye_radius = static_cast<float>(eye_radius);
  equation.sine = static_cast<float>(sine);
  equation.half_length = static_cast<float>(half_length);
  equation.inverse_constant = static_cast<float>(1.0 / constant);
  equation.per_length = static_cast<float>(per_length);
  equation.outside = outside;
  equation.least_side = static_cast<float>(0x1p-20 * side);
  equation.least_root = static_cast<float>(0x1p-18 * longest_squared);
  return equation;
}

}  // namespace beambench::accel::tile_beam
