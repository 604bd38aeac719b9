#include "accel/beam/primitive_image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

namespace beambench::accel::beam {
namespace {

/// The error of a sum of three products in float, relative to the sum of their magnitudes: one
/// rounding each of coefficients and places, and three more.
constexpr double kFloatLoss = 0x1p-21;

constexpr std::size_t kPage = 1024;
constexpr std::uint32_t kNotMade = std::numeric_limits<std::uint32_t>::max();

/// An image that no sample fails.
constexpr TriangleImage kAnywhere{{{{0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 1.0F}, {0.0F, 0.0F, 1.0F}}},
                                  {0.0F, 0.0F, std::numeric_limits<float>::infinity()}};
constexpr SphereImage kAnywhereRound{0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F};

}  // namespace

PrimitiveImages::PrimitiveImages(const scenes::Scene& scene, const EyeView& view,
                                 const PrimaryRays& rays, const ProbeKernels& kernels)
    : scene_(&scene),
      kernels_(&kernels),
      eye_(view.eye()),
      forward_(rays.forward()),
      top_left_(rays.top_left()),
      right_(rays.right()),
      down_(rays.down()),
      size_(rays.width(), rays.height()),
      deviation_(view.deviation()),
      places_(scene.primitives.size() / kPage + 1) {}

std::uint32_t& PrimitiveImages::place_of(scenes::PrimitiveId id) {
  std::vector<std::uint32_t>& page = places_[id / kPage];
  if (page.empty()) page.assign(kPage, kNotMade);
  return page[id % kPage];
}

SampleMask PrimitiveImages::may_hit(scenes::PrimitiveId id, const SampleBatch& batch) {
  const scenes::Primitive& primitive = scene_->primitives[id];
  std::uint32_t& place = place_of(id);
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kPolygon: {
      const scenes::Polygon& polygon = scene_->polygons[primitive.index];
      if (place == kNotMade) {
        place = static_cast<std::uint32_t>(triangles_.size());
        for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
          triangles_.push_back(
              image_of_triangle(scene_->triangles[polygon.first_triangle + i].vertex));
        }
      }
      return kernels_->triangles({&triangles_[place], polygon.triangle_count}, batch);
    }
    case scenes::PrimitiveKind::kSphere:
      if (place == kNotMade) {
        place = static_cast<std::uint32_t>(spheres_.size());
        spheres_.push_back(image_of_sphere(scene_->spheres[primitive.index]));
      }
      return kernels_->sphere(spheres_[place], batch);
    case scenes::PrimitiveKind::kCone:
      break;
  }
  return all_samples(batch);
}

TriangleImage PrimitiveImages::image_of_triangle(
    const std::array<std::uint32_t, 3>& vertices) const {
  std::array<glm::dvec3, 3> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    corners[i] = glm::dvec3(scene_->vertices[vertices[i]]) - eye_;
  }
  const double volume = glm::dot(corners[0], glm::cross(corners[1], corners[2]));
  const double reach = glm::length(corners[0]) * glm::length(corners[1]) * glm::length(corners[2]);
  // The eye is in the triangle's plane, or so close to it that the signs are uncertain.
  if (!(std::abs(volume) > 1e-9 * reach)) return kAnywhere;

  // A plane through the eye, or 1/t of a plane, as a line on the image.
  const auto widened_line = [&](const glm::dvec3& normal) {
    const double x = glm::dot(normal, right_);
    const double y = glm::dot(normal, down_);
    const double constant = glm::dot(normal, top_left_);
    const double loss =
        deviation_ * glm::length(normal) +
        kFloatLoss * (std::abs(x) * size_.x + std::abs(y) * size_.y + std::abs(constant));
    return PixelLine{static_cast<float>(x), static_cast<float>(y),
                     static_cast<float>(constant + loss)};
  };
  const double inward = (volume > 0.0 ? 1.0 : -1.0);
  TriangleImage image{};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 normal = glm::cross(corners[i], corners[(i + 1) % 3]);
    image.edges[i] = widened_line(normal * (inward / glm::length(normal)));
  }
  const glm::dvec3 plane = glm::cross(corners[1] - corners[0], corners[2] - corners[0]) / volume;
  if (!(glm::length(plane) < 1e30)) return kAnywhere;  // too close for float
  image.inverse_t = widened_line(plane);
  return image;
}

SphereImage PrimitiveImages::image_of_sphere(const scenes::Sphere& sphere) const {
  const glm::dvec3 center = glm::dvec3(sphere.center) - eye_;
  const double depth = glm::dot(center, forward_);
  const double distance = glm::length(center);
  const double radius = std::abs(static_cast<double>(sphere.radius));
  // A sphere around, next to or behind the eye has an outline that is not an ellipse, or a very
  // long one.
  if (!(depth > 0.1 * distance) || !(radius < 0.9 * distance)) return kAnywhereRound;

  const glm::dvec3 middle = center / depth;  // at view depth 1, like all directions
  // The steps right and down need not be perpendicular.
  const glm::dmat2 steps(glm::dot(right_, right_), glm::dot(right_, down_), glm::dot(right_, down_),
                         glm::dot(down_, down_));
  const glm::dvec3 offset = middle - top_left_;
  const glm::dvec2 place =
      glm::inverse(steps) * glm::dvec2(glm::dot(offset, right_), glm::dot(offset, down_));
  // A sample's place relative to the center and its direction are rounded to float: enlarge the
  // sphere by both errors.
  const double slip = deviation_ + 0x1p-22 * ((std::abs(place.x) + size_.x) * glm::length(right_) +
                                              (std::abs(place.y) + size_.y) * glm::length(down_));
  const double shift = 4.0 * slip * distance;
  if (!(shift < radius)) return kAnywhereRound;
  const double wider = radius * (1.0 + 0x1p-7) + 2.0 * shift;
  const double squared = wider * wider;

  // (d . c)^2 - |d|^2 (|c|^2 - r^2) >= 0 with d = middle + u right + v down.
  const auto product = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dot(a, center) * glm::dot(b, center) -
           glm::dot(a, b) * (distance * distance - squared);
  };
  const double scale = 1.0 / (glm::dot(middle, middle) * squared);
  const auto scaled = [&](double value) { return static_cast<float>(value * scale); };
  return {static_cast<float>(place.x), static_cast<float>(place.y), scaled(product(right_, right_)),
          scaled(2.0 * product(right_, down_)), scaled(product(down_, down_)),
          // middle is parallel to the center, so the large terms cancel exactly.
          scaled(2.0 * glm::dot(middle, right_) * squared),
          scaled(2.0 * glm::dot(middle, down_) * squared), 1.0F};
}

}  // namespace beambench::accel::beam
