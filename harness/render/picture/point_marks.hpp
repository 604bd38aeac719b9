#pragma once
// Points of the scene marked in a picture.

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

/// Points that mean the same.
struct PointGroup {
  Category category;
  std::vector<glm::dvec3> points;
};

/// Dims the picture that `rays` show and marks each point with a framed dot, the later groups over
/// the earlier, also where a surface hides it: what is looked for may lie inside of something.
/// Returns what the colors stand for with the numbers of points, and how many are outside of the
/// picture.
std::vector<LegendEntry> mark_points(Image& image, const accel::PrimaryRays& rays,
                                     std::span<const PointGroup> groups);

}  // namespace beambench::render
