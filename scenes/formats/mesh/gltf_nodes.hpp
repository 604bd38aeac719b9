#pragma once
// The nodes of a glTF file's scene, with their placement in the world.

#include <vector>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

namespace beambench::scenes::mesh {

/// A node, and the matrix from its coordinates to the scene's.
struct PlacedNode {
  const tinygltf::Node* node;
  glm::dmat4 to_world;
  int number;  ///< in the file
  int parent;  ///< its number; -1 for a root
};

/// Returns all nodes of the file's default scene (the first scene if no default is stated, all
/// nodes if there are no scenes), parents before children, in the order of the file. They must not
/// outlive the model. Throws InputError if a node does not exist or is reached twice: a cycle, or
/// two parents.
std::vector<PlacedNode> placed_nodes(const tinygltf::Model& model);

}  // namespace beambench::scenes::mesh
