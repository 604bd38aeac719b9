#include "scenes/formats/mesh/gltf_nodes.hpp"

#include <cstddef>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/formats/mesh/gltf_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Requires that a list of numbers have the length that glTF prescribes, or be missing.
void require_length(const std::vector<double>& list, std::size_t length, int node,
                    const char* name) {
  if (list.empty() || list.size() == length) return;
  refuse_gltf(fmt::format("node {} has a {} of {} numbers, which must be {}", node, name,
                          list.size(), length));
}

glm::dmat4 local_matrix(const tinygltf::Node& node, int number) {
  require_length(node.matrix, 16, number, "matrix");
  require_length(node.translation, 3, number, "translation");
  require_length(node.rotation, 4, number, "rotation");
  require_length(node.scale, 3, number, "scale");
  glm::dmat4 matrix(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return matrix;
  }
  if (!node.rotation.empty()) {
    const auto& r = node.rotation;
    const glm::dquat rotation(r[3], r[0], r[1], r[2]);
    matrix = glm::mat4_cast(glm::normalize(rotation));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    if (!node.scale.empty()) matrix[axis] *= node.scale[i];
    if (!node.translation.empty()) matrix[3][axis] = node.translation[i];
  }
  return matrix;
}

/// Returns the root nodes of a scene; in a file without scenes, the nodes without a parent.
std::vector<int> root_nodes(const tinygltf::Model& model) {
  std::vector<int> roots;
  if (!model.scenes.empty()) {
    const int scene = model.defaultScene < 0 ? 0 : model.defaultScene;
    roots = element_of(model.scenes, scene, "scene", "the file").nodes;
    return roots;
  }
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      element_of(model.nodes, child, "node", "a node");
      is_child[static_cast<std::size_t>(child)] = true;
    }
  }
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

/// A node still to be placed.
struct Pending {
  int node;
  int parent;
  glm::dmat4 parent_to_world;
};

}  // namespace

std::vector<PlacedNode> placed_nodes(const tinygltf::Model& model) {
  std::vector<PlacedNode> placed;
  std::vector<bool> reached(model.nodes.size(), false);
  std::vector<Pending> pending;
  const auto add = [&](const std::vector<int>& nodes, int parent, const glm::dmat4& to_world) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
      pending.push_back({*node, parent, to_world});
  };
  add(root_nodes(model), -1, glm::dmat4(1.0));
  while (!pending.empty()) {  // no recursion: a file may nest nodes arbitrarily deep
    const Pending next = pending.back();
    pending.pop_back();
    const tinygltf::Node& node = element_of(model.nodes, next.node, "node", "a node or scene");
    if (reached[static_cast<std::size_t>(next.node)]) {
      refuse_gltf(
          fmt::format("node {} is in its scene twice, so the nodes do not form a tree", next.node));
    }
    reached[static_cast<std::size_t>(next.node)] = true;
    const glm::dmat4 to_world = next.parent_to_world * local_matrix(node, next.node);
    placed.push_back({&node, to_world, next.node, next.parent});
    add(node.children, next.node, to_world);
  }
  return placed;
}

}  // namespace beambench::scenes::mesh
