#include "harness/render/light_buffer.hpp"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/intersect.hpp"
#include "accel/core/tolerance.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

/// A box as the light sees it.
struct LitBox {
  dvec3 low;
  dvec3 high;
};

/// Wide enough for all that rounding does: a hit may lie beside its primitive, and a shadow ray,
/// whose numbers are floats, beside the straight way to the light.
LitBox lit_box(const scenes::Scene& scene, scenes::PrimitiveId id, const dvec3& light) {
  const double size = scene.bounds.largest_coordinate() + glm::length(light);
  const double slack = accel::overlap_tolerance(scene) + 0x1p-20 * size;
  const scenes::Bounds bounds = scenes::primitive_bounds(scene, id);
  return {dvec3(bounds.lower) - light - slack, dvec3(bounds.upper) - light + slack};
}

double distance_to(const LitBox& box) {
  return glm::length(glm::max(glm::max(box.low, -box.high), dvec3(0.0)));
}

struct Range {
  double low;
  double high;
};

/// The least size of a number of a range.
double least_size(const Range& range) { return std::max({range.low, -range.high, 0.0}); }

/// What a range of one coordinate, divided by depths, covers of a face, which is [-1, 1].
Range projected(const Range& range, const Range& depth) {
  if (depth.low <= 0.0) return {-1.0, 1.0};  // the light is in the box's shadow on this face
  return {std::max(range.low / (range.low < 0.0 ? depth.low : depth.high), -1.0),
          std::min(range.high / (range.high > 0.0 ? depth.low : depth.high), 1.0)};
}

int cell_at(double place, int cells) {
  return std::clamp(static_cast<int>(std::floor((place + 1.0) * 0.5 * cells)), 0, cells - 1);
}

std::size_t cell_index(int face, int u, int v, int cells) {
  return (static_cast<std::size_t>(face) * static_cast<std::size_t>(cells) +
          static_cast<std::size_t>(v)) *
             static_cast<std::size_t>(cells) +
         static_cast<std::size_t>(u);
}

/// Calls `visit(cell)` for all cells through which a box may be seen.
template <class Visit>
void visit_cells(const LitBox& box, int cells, Visit visit) {
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const Range along = face % 2 == 0 ? Range{box.low[axis], box.high[axis]}
                                      : Range{-box.high[axis], -box.low[axis]};
    if (along.high <= 0.0) continue;
    const Range u_range{box.low[(axis + 1) % 3], box.high[(axis + 1) % 3]};
    const Range v_range{box.low[(axis + 2) % 3], box.high[(axis + 2) % 3]};
    // Only what is deeper than it is far aside is seen through this face.
    const Range depth{std::max({along.low, least_size(u_range), least_size(v_range)}), along.high};
    if (depth.low > depth.high) continue;
    const Range u = projected(u_range, depth);
    const Range v = projected(v_range, depth);
    if (u.low > u.high || v.low > v.high) continue;
    for (int row = cell_at(v.low, cells); row <= cell_at(v.high, cells); ++row) {
      for (int column = cell_at(u.low, cells); column <= cell_at(u.high, cells); ++column) {
        visit(cell_index(face, column, row, cells));
      }
    }
  }
}

bool is_transparent(const scenes::Scene& scene, scenes::PrimitiveId id) {
  return scene.surfaces[scene.primitives[id].surface].transmittance > 0.0F;
}

}  // namespace

LightBuffer::LightBuffer(const scenes::Scene& scene, const glm::vec3& light, int cells)
    : scene_(&scene), light_(light), cells_(cells), first_(cell_index(6, 0, 0, cells) + 1) {
  const auto count = static_cast<scenes::PrimitiveId>(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    visit_cells(lit_box(scene, id, light_), cells, [&](std::size_t cell) { ++first_[cell + 1]; });
  }
  for (std::size_t cell = 1; cell < first_.size(); ++cell) first_[cell] += first_[cell - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (scenes::PrimitiveId id = 0; id < count; ++id) {
    const LitBox box = lit_box(scene, id, light_);
    const double near = distance_to(box);
    visit_cells(box, cells, [&](std::size_t cell) { entries_[next[cell]++] = {near, id}; });
  }
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
    std::sort(entries_.begin() + first_[cell], entries_.begin() + first_[cell + 1],
              [](const Entry& a, const Entry& b) {
                return a.near != b.near ? a.near < b.near : a.primitive < b.primitive;
              });
  }
}

std::size_t LightBuffer::cell_of(const dvec3& direction) const {
  const dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int face = 2 * axis + (direction[axis] < 0.0 ? 1 : 0);
  const double depth = size[axis] > 0.0 ? size[axis] : 1.0;
  return cell_index(face, cell_at(direction[(axis + 1) % 3] / depth, cells_),
                    cell_at(direction[(axis + 2) % 3] / depth, cells_), cells_);
}

LightBuffer::Answer LightBuffer::ask(const accel::Ray& to_light, std::uint64_t& tests) const {
  const dvec3 from_light = dvec3(to_light.origin) - light_;
  const double distance = glm::length(from_light);
  const std::size_t cell = cell_of(from_light);
  const accel::CanonicalRay ray(to_light);
  Answer answer = Answer::kFree;
  for (std::size_t i = first_[cell]; i < first_[cell + 1] && entries_[i].near <= distance; ++i) {
    ++tests;
    const scenes::PrimitiveId id = entries_[i].primitive;
    if (!accel::is_hit(accel::intersect(ray, *scene_, id))) continue;
    if (!is_transparent(*scene_, id)) return Answer::kHidden;
    answer = Answer::kTransparent;
  }
  return answer;
}

std::size_t LightBuffer::memory_bytes() const {
  return sizeof(*this) + first_.capacity() * sizeof(first_[0]) +
         entries_.capacity() * sizeof(entries_[0]);
}

}  // namespace beambench::render
