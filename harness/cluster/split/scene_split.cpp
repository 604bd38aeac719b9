#include "harness/cluster/split/scene_split.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

#include "accel/core/tolerance.hpp"

namespace beambench::cluster {
namespace {

/// Calls `visit(cell)` for all cells of a range.
template <class Visit>
void for_each_cell(const accel::CellRange& range, Visit visit) {
  for (int z = range.first[2]; z <= range.last[2]; ++z) {
    for (int y = range.first[1]; y <= range.last[1]; ++y) {
      for (int x = range.first[0]; x <= range.last[0]; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

std::uint32_t morton(const glm::ivec3& cell) {
  std::uint32_t code = 0;
  for (unsigned bit = 0; bit < 7; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<std::uint32_t>(cell[static_cast<int>(axis)]);
      code |= (coordinate >> bit & 1U) << (3 * bit + axis);
    }
  }
  return code;
}

/// Copies primitives with all that they refer to, each vertex once.
class PartBuilder {
 public:
  PartBuilder(const scenes::Scene& whole, ScenePart& part) : whole_(&whole), part_(&part) {}

  void add(scenes::PrimitiveId id) {
    scenes::Scene& scene = part_->scene;
    scenes::Primitive primitive = whole_->primitives[id];
    switch (primitive.kind) {
      case scenes::PrimitiveKind::kSphere:
        scene.spheres.push_back(whole_->spheres[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(scene.spheres.size() - 1);
        break;
      case scenes::PrimitiveKind::kCone:
        scene.cones.push_back(whole_->cones[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(scene.cones.size() - 1);
        break;
      case scenes::PrimitiveKind::kPolygon:
        add_polygon(whole_->polygons[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(scene.polygons.size() - 1);
        break;
    }
    scene.primitives.push_back(primitive);
    part_->global.push_back(id);
  }

 private:
  void add_polygon(scenes::Polygon polygon) {
    scenes::Scene& scene = part_->scene;
    const auto first_corner = static_cast<std::uint32_t>(scene.corners.size());
    const auto first_triangle = static_cast<std::uint32_t>(scene.triangles.size());
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      scene.corners.push_back(vertex(whole_->corners[polygon.first_corner + i]));
    }
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      scenes::Triangle triangle = whole_->triangles[polygon.first_triangle + i];
      for (std::uint32_t& each : triangle.vertex) each = vertex(each);
      triangle.primitive = static_cast<scenes::PrimitiveId>(scene.primitives.size());
      scene.triangles.push_back(triangle);
    }
    if (polygon.first_normal != scenes::Polygon::kFlat) {
      const auto first = whole_->normals.begin() + polygon.first_normal;
      polygon.first_normal = static_cast<std::uint32_t>(scene.normals.size());
      scene.normals.insert(scene.normals.end(), first, first + polygon.corner_count);
    }
    polygon.first_corner = first_corner;
    polygon.first_triangle = first_triangle;
    scene.polygons.push_back(polygon);
  }

  std::uint32_t vertex(std::uint32_t index) {
    auto& vertices = part_->scene.vertices;
    const auto [found, is_new] =
        places_.emplace(index, static_cast<std::uint32_t>(vertices.size()));
    if (is_new) vertices.push_back(whole_->vertices[index]);
    return found->second;
  }

  const scenes::Scene* whole_;
  ScenePart* part_;
  std::unordered_map<std::uint32_t, std::uint32_t> places_;  ///< of vertices
};

}  // namespace

SceneSplit::SceneSplit(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
                       int level, int processes)
    : level_(level), cells_(1 << (level - 1)) {
  accel::octree::OctreeOptions coarse = options;
  coarse.max_level = level;
  const accel::CellGrid grid = accel::octree::octree_grid(scene, coarse);
  const auto count = static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_) *
                     static_cast<std::size_t>(cells_);
  // A little for each cell, so that empty ones are distributed, too.
  std::vector<double> weight(count, 0.01);
  ranges_.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    ranges_.push_back(accel::cell_range(grid, scenes::primitive_bounds(scene, id),
                                        accel::overlap_tolerance(scene)));
    for_each_cell(ranges_.back(), [&](const glm::ivec3& cell) { weight[index(cell)] += 1.0; });
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, {}, [&](std::uint32_t i) { return morton(cell(i)); });
  const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
  owners_.resize(count);
  double before = 0.0;
  for (const std::uint32_t i : order) {
    const double middle = (before + 0.5 * weight[i]) / total;
    owners_[i] = static_cast<std::uint16_t>(
        std::min(processes - 1, static_cast<int>(middle * static_cast<double>(processes))));
    before += weight[i];
  }
}

bool SceneSplit::reaches(ProcessId process, scenes::PrimitiveId id) const {
  bool found = false;
  for_each_cell(ranges_[id],
                [&](const glm::ivec3& cell) { found = found || owner(index(cell)) == process; });
  return found;
}

ScenePart part_of(const scenes::Scene& scene, const SceneSplit& split, ProcessId process) {
  ScenePart part;
  part.scene.name = scene.name;
  part.scene.cameras = scene.cameras;
  part.scene.background = scene.background;
  part.scene.lights = scene.lights;
  part.scene.surfaces = scene.surfaces;
  part.scene.bounds = scene.bounds;
  PartBuilder builder(scene, part);
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (split.reaches(process, id)) builder.add(id);
  }
  scenes::Scene& kept = part.scene;
  const auto shrink = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
  shrink(kept.primitives, kept.spheres, kept.cones, kept.polygons, kept.triangles, kept.vertices,
         kept.corners, kept.normals, part.global);
  return part;
}

}  // namespace beambench::cluster
