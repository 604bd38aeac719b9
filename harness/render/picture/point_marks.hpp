#pragma once
// Marks points of the scene in a picture.

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

/// Points with the same meaning.
struct PointGroup {
  Category category;
  std::vector<glm::dvec3> points;
};

/// Dims the picture shown by `rays` and marks each point with a framed dot, later groups over
/// earlier ones. Hidden points are marked, too, because points of interest may be inside objects.
/// Returns the meaning of the colors with the number of points of each, and the number outside the
/// picture.
std::vector<LegendEntry> mark_points(Image& image, const accel::PrimaryRays& rays,
                                     std::span<const PointGroup> groups);

}  // namespace beambench::render
