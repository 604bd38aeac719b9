// Mesh import by tinygltf.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <tiny_gltf.h>

#include "scenes/base/error.hpp"
#include "scenes/bounds.hpp"
#include "scenes/formats/mesh/gltf_accessors.hpp"
#include "scenes/formats/mesh/gltf_file.hpp"
#include "scenes/formats/mesh/gltf_materials.hpp"
#include "scenes/formats/mesh/gltf_motion.hpp"
#include "scenes/formats/mesh/gltf_nodes.hpp"
#include "scenes/formats/mesh/gltf_views.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/formats/mesh/mesh_motion.hpp"

namespace beambench::scenes::mesh {
namespace {

/// The version of this importer; increment it whenever this file or its callees read a mesh
/// differently.
constexpr int kOwnVersion = 2;

/// The maximum number of triangles, and of vertices in primitives with triangles. A short file may
/// place a mesh many times, so larger files are refused before any triangle is made: such a scene
/// would need more than 20 GB.
constexpr std::size_t kMaxTriangles = std::size_t{1} << 28U;

constexpr const char* kPosition = "POSITION";

/// One primitive of a mesh, at one node.
struct PlacedPrimitive {
  const tinygltf::Primitive* primitive;
  int positions;
  std::size_t corners;    ///< number of its triangles' corners
  std::size_t triangles;  ///< 0 for points and lines
};

/// Parts of the file that are left out or that differ in the scene.
struct Notes {
  std::size_t points_and_lines = 0;
  std::size_t masked_triangles = 0;
  std::size_t morphed_nodes = 0;     ///< nodes with morph targets
  std::size_t instancing_nodes = 0;  ///< nodes with EXT_mesh_gpu_instancing
};

bool has_triangles(int mode) {
  return mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

/// Returns the number of points or lines in a primitive: points, lines, a line strip or a line
/// loop.
std::size_t points_or_lines(int mode, std::size_t corners) {
  if (mode == TINYGLTF_MODE_LINE) return corners / 2;
  if (mode == TINYGLTF_MODE_LINE_STRIP) return corners > 0 ? corners - 1 : 0;
  return corners;
}

std::size_t triangle_count(int mode, std::size_t corners, std::string_view name) {
  if (mode != TINYGLTF_MODE_TRIANGLES) return corners < 3 ? 0 : corners - 2;
  if (corners % 3 != 0) {
    refuse_gltf(
        fmt::format("{} has triangles of {} corners, which is not a multiple of 3", name, corners));
  }
  return corners / 3;
}

/// Returns the corners of one triangle of a triangle list, strip or fan, with consistent winding.
std::array<std::size_t, 3> corners_of(int mode, std::size_t triangle) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {triangle + 1, triangle + 2, 0};
  const std::size_t odd = triangle % 2;
  return {triangle, triangle + 1 + odd, triangle + 2 - odd};
}

/// Inspects a primitive without reading it. Returns nothing if it has no positions and thus no
/// shape.
std::optional<PlacedPrimitive> look_at(const tinygltf::Model& model,
                                       const tinygltf::Primitive& primitive,
                                       std::string_view name) {
  if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    refuse_gltf(fmt::format("{} has the unknown mode {}", name, primitive.mode));
  }
  const auto positions = primitive.attributes.find(kPosition);
  if (positions == primitive.attributes.end()) return std::nullopt;
  const std::size_t corners = primitive.indices >= 0
                                  ? GltfElements(model, primitive.indices).size()
                                  : GltfElements(model, positions->second).size();
  const std::size_t triangles =
      has_triangles(primitive.mode) ? triangle_count(primitive.mode, corners, name) : 0;
  return PlacedPrimitive{&primitive, positions->second, corners, triangles};
}

/// Adds to a sum and throws if it then exceeds `kMaxTriangles`.
void add_bounded(std::size_t& sum, std::size_t more, std::string_view what) {
  if (more <= kMaxTriangles && sum + more <= kMaxTriangles) {
    sum += more;
    return;
  }
  throw InputError(fmt::format("its nodes place more than {} {}; split it, or reduce its triangles",
                               kMaxTriangles, what));
}

/// Collects the meshes of the nodes as triangles in the scene's coordinates.
class GltfCollector {
 public:
  GltfCollector(const tinygltf::Model& model, GltfMotion& motion)
      : model_(&model), motion_(&motion) {}

  /// Throws InputError if there would be too many triangles; reads no positions.
  void add(const PlacedNode& node) {
    if (node.node->mesh < 0) return;
    if (node.node->extensions.contains("EXT_mesh_gpu_instancing")) ++notes_.instancing_nodes;
    Instance& instance = instances_.emplace_back();
    instance.node = &node;
    const tinygltf::Mesh& mesh = element_of(model_->meshes, node.node->mesh, "mesh", "a node");
    const bool is_morphed = std::ranges::any_of(
        mesh.primitives,
        [](const tinygltf::Primitive& primitive) { return !primitive.targets.empty(); });
    if (is_morphed) ++notes_.morphed_nodes;
    if (node.node->skin >= 0) {
      instance.matrix = motion_->matrices_of_skin(node.node->skin);
    } else if (motion_->moves(node)) {
      instance.matrix = motion_->matrix_of(node);
    }
    std::set<int> counted;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const std::string name = fmt::format("primitive {} of mesh {}", i, node.node->mesh);
      const auto found = look_at(*model_, mesh.primitives[i], name);
      if (!found) continue;
      if (found->triangles == 0) {
        notes_.points_and_lines += points_or_lines(found->primitive->mode, found->corners);
        continue;
      }
      add_bounded(triangles_, found->triangles, "triangles");
      if (counted.insert(found->positions).second) {
        add_bounded(vertices_, GltfElements(*model_, found->positions).size(), "vertices");
      }
      instance.primitives.push_back(*found);
    }
  }

  /// Makes the triangles.
  ImportedMesh collect() && {
    collector_.reserve(std::min(vertices_, 3 * triangles_), triangles_);
    for (const Instance& instance : instances_) {
      // Primitives of a mesh may share positions but, with a skin, not their weights.
      std::map<std::pair<int, std::size_t>, SharedVertices> shared;
      for (std::size_t i = 0; i < instance.primitives.size(); ++i) {
        const PlacedPrimitive& placed = instance.primitives[i];
        const std::pair key(placed.positions, has_skin(instance) ? i : 0);
        auto found = shared.find(key);
        if (found == shared.end()) found = shared.emplace(key, vertices_of(placed, instance)).first;
        add_triangles(placed, found->second);
      }
      if (motion_->frames() == 1 || !instance.matrix) continue;
      for (const auto& [key, vertices] : shared) {
        const PlacedPrimitive& first = instance.primitives[key.second];
        record(instance, {first.primitive, key.first, 0, 0}, vertices);
      }
    }
    ImportedMesh result = collected_mesh(std::move(collector_), notes_.points_and_lines);
    warn(result.warnings);
    if (!moving_.influences.empty()) {
      moving_.frames = motion_->frames();
      moving_.vertices.resize(result.mesh.vertices.size());
      moving_.matrices = motion_->all_matrices();
      result.motion = std::move(moving_);
    } else if (!model_->animations.empty()) {
      result.warnings.emplace_back("its animation moves no triangles");
    }
    return result;
  }

 private:
  struct Instance {
    const PlacedNode* node = nullptr;
    std::optional<std::uint32_t>
        matrix{};  ///< of the node or its skin's first joint; empty if it is static
    std::vector<PlacedPrimitive> primitives{};
  };

  static bool has_skin(const Instance& instance) { return instance.node->node->skin >= 0; }

  /// Calls visit(vertex, rest, influences) for the `wanted` vertices of a moved instance.
  template <typename Wanted, typename Visit>
  void for_each_moved(const Instance& instance, const PlacedPrimitive& placed, Wanted wanted,
                      Visit visit) const {
    const GltfPositions positions(*model_, placed.positions);
    std::optional<GltfWeights> weights;
    std::size_t joints = 0;
    if (has_skin(instance)) {
      weights.emplace(*model_, *placed.primitive, positions.size());
      joints = model_->skins[static_cast<std::size_t>(instance.node->node->skin)].joints.size();
    }
    std::vector<Influence> influences{{*instance.matrix, 1.0}};
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!wanted(i)) continue;
      if (weights) {
        influences.clear();
        weights->append(i, *instance.matrix, joints, influences);
      }
      visit(i, positions.at(i), influences);
    }
  }

  SharedVertices vertices_of(const PlacedPrimitive& placed, const Instance& instance) const {
    std::vector<glm::vec3> places;
    if (instance.matrix) {
      for_each_moved(
          instance, placed, [](std::size_t) { return true; },
          [&](std::size_t, const glm::dvec3& rest, const std::vector<Influence>& influences) {
            places.push_back(moved(rest, influences, motion_->matrices()));
          });
      return SharedVertices(std::move(places), motion_->frames() == 1);
    }
    const GltfPositions positions(*model_, placed.positions);
    places.reserve(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      places.emplace_back(glm::dvec3(instance.node->to_world * glm::dvec4(positions.at(i), 1.0)));
    }
    return SharedVertices(std::move(places));
  }

  /// Records how the collected vertices of an instance move.
  void record(const Instance& instance, const PlacedPrimitive& placed,
              const SharedVertices& vertices) {
    for_each_moved(
        instance, placed, [&](std::size_t i) { return vertices.collected(i).has_value(); },
        [&](std::size_t i, const glm::dvec3& rest, const std::vector<Influence>& influences) {
          const std::uint32_t vertex = *vertices.collected(i);
          if (vertex >= moving_.vertices.size()) moving_.vertices.resize(vertex + std::size_t{1});
          moving_.vertices[vertex] = {rest, static_cast<std::uint32_t>(moving_.influences.size()),
                                      static_cast<std::uint32_t>(influences.size())};
          moving_.influences.insert(moving_.influences.end(), influences.begin(), influences.end());
        });
  }

  void add_triangles(const PlacedPrimitive& placed, SharedVertices& vertices) {
    const tinygltf::Primitive& primitive = *placed.primitive;
    const GltfSurface surface = gltf_surface(*model_, primitive.material);
    if (surface.has_mask) notes_.masked_triangles += placed.triangles;
    collector_.set_surface(surface.surface);
    std::optional<GltfIndices> indices;
    if (primitive.indices >= 0) indices.emplace(*model_, primitive.indices);
    for (std::size_t i = 0; i < placed.triangles; ++i) {
      std::array<std::uint32_t, 3> corners{};
      const auto places = corners_of(primitive.mode, i);
      for (std::size_t j = 0; j < 3; ++j) {
        corners[j] = indices ? indices->at(places[j]) : static_cast<std::uint32_t>(places[j]);
        if (corners[j] >= vertices.places().size()) {
          refuse_gltf(fmt::format("accessor {} has the index {}, but there are {} vertices",
                                  primitive.indices, corners[j], vertices.places().size()));
        }
      }
      collector_.add(vertices, corners);
    }
  }

  void warn(std::vector<std::string>& warnings) const {
    if (notes_.masked_triangles > 0) {
      warnings.push_back(
          fmt::format("{} triangles have alpha-masked materials; they are traced as opaque",
                      notes_.masked_triangles));
    }
    if (notes_.morphed_nodes > 0) {
      warnings.push_back(
          fmt::format("{} nodes have morph targets, which were left out", notes_.morphed_nodes));
    }
    if (notes_.instancing_nodes > 0) {
      warnings.push_back(
          fmt::format("{} nodes have instances by EXT_mesh_gpu_instancing; each is one mesh",
                      notes_.instancing_nodes));
    }
  }

  const tinygltf::Model* model_;
  GltfMotion* motion_;
  MeshMotion moving_;
  std::vector<Instance> instances_;
  std::size_t triangles_ = 0;
  std::size_t vertices_ = 0;
  Notes notes_;
  MeshCollector collector_;
};

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds bounds;
  for (const glm::vec3& vertex : mesh.vertices) bounds.include(vertex);
  return bounds;
}

ImportedMesh import_scene(std::string_view bytes, MeshCompanions& companions) {
  tinygltf::Model model = read_gltf(bytes, companions);
  std::vector<std::string> notes;
  GltfMotion motion(model, notes);
  const std::span<const PlacedNode> nodes = motion.nodes();
  GltfCollector collector(model, motion);
  for (const PlacedNode& node : nodes) collector.add(node);
  ImportedMesh result = std::move(collector).collect();
  result.warnings.insert(result.warnings.end(), notes.begin(), notes.end());
  const Bounds bounds = bounds_of(result.mesh);
  result.cameras = gltf_cameras(model, nodes, bounds, result.warnings);
  result.lights = gltf_lights(model, nodes, bounds, result.warnings);
  result.companions = companions.list();
  return result;
}

ImportedMesh import_by_tinygltf(std::string_view bytes, const std::string&,
                                const std::filesystem::path& path) {
  MeshCompanions companions(path, bytes.size());
  try {
    return import_scene(bytes, companions);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

Importer gltf_importer() { return {fmt::format("tinygltf-{}", kOwnVersion), import_by_tinygltf}; }

}  // namespace beambench::scenes::mesh
