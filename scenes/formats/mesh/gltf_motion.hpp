#pragma once
// The motion in a glTF file: its frames, and the matrices of nodes and joints.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

#include "scenes/formats/mesh/gltf_accessors.hpp"
#include "scenes/formats/mesh/gltf_animation.hpp"
#include "scenes/formats/mesh/gltf_nodes.hpp"
#include "scenes/formats/mesh/mesh_motion.hpp"

namespace beambench::scenes::mesh {

/// Frames per second.
inline constexpr double kFrameRate = 24.0;
/// The maximum number of frames; a longer animation has this many, evenly spaced.
inline constexpr std::uint32_t kMaxFrames = 1000;

/// The first animation of a file, sampled at times from 0, and the matrices that move the meshes.
class GltfMotion {
 public:
  /// Moves the model's nodes to frame 0. Appends warnings about omitted parts. Throws like
  /// `GltfAnimation` and `placed_nodes`. The model must outlive this object.
  GltfMotion(tinygltf::Model& model, std::vector<std::string>& warnings);

  std::uint32_t frames() const { return frames_; }
  /// Returns the nodes in frame 0.
  std::span<const PlacedNode> nodes() const { return nodes_; }
  /// Returns whether the node or one of its ancestors moves.
  bool moves(const PlacedNode& node) const;

  /// Returns the index of the matrix that places the node in each frame.
  std::uint32_t matrix_of(const PlacedNode& node);
  /// Returns the index of the matrix of a skin's first joint; those of the other joints follow.
  /// Throws an InputError that names the skin if it has no joints, a joint is not in the scene, or
  /// its matrices are invalid.
  std::uint32_t matrices_of_skin(int skin);
  /// Returns the matrices in frame 0.
  std::span<const glm::dmat4> matrices() const { return matrices_; }

  /// Returns the matrices of all frames, leaving the nodes in the last frame. The constructor has
  /// omitted frames that would need too much memory.
  std::vector<glm::dmat4> all_matrices();

 private:
  struct Source {
    int node;
    glm::dmat4 before;
  };

  void choose_frames(std::vector<std::string>& warnings);
  std::uint32_t add(const Source& source);
  double time_of(std::uint32_t frame) const;

  tinygltf::Model* model_;
  std::optional<GltfAnimation> animation_;
  std::uint32_t frames_ = 1;
  double step_ = 0.0;
  std::vector<PlacedNode> nodes_;
  std::map<int, const PlacedNode*> node_of_;
  std::vector<bool> moving_;  // by the node's number
  std::map<int, std::uint32_t> skins_;
  std::vector<Source> sources_;
  std::vector<glm::dmat4> matrices_;
};

/// The joints that move the vertices of a primitive, with their weights.
class GltfWeights {
 public:
  /// Throws InputError if the primitive has no joints and weights, or not as many of them as
  /// vertices.
  GltfWeights(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
              std::size_t vertices);

  /// Appends the influences of a vertex, with weights scaled to a sum of 1; if all are 0, the first
  /// joint gets the weight 1. Throws InputError if a weight is negative or not finite, or if a
  /// joint does not exist.
  void append(std::size_t vertex, std::uint32_t first_matrix, std::size_t joints,
              std::vector<Influence>& influences) const;

 private:
  struct Set {
    GltfNumbers joints;
    GltfNumbers weights;
  };
  std::vector<Set> sets_;
};

}  // namespace beambench::scenes::mesh
