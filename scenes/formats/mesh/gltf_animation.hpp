#pragma once
// Animations of nodes in glTF files.

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <tiny_gltf.h>

namespace beambench::scenes::mesh {

/// An animation: the values that its channels assign to nodes at a time.
class GltfAnimation {
 public:
  /// Reads an animation. Throws an InputError that names the channel or sampler if it is malformed:
  /// an accessor that is missing or of another type, times that are not finite or do not increase,
  /// values that are not finite, or whose number is not one per time (three for CUBICSPLINE), an
  /// unknown interpolation, two channels for the same target, or a node with a matrix.
  GltfAnimation(const tinygltf::Model& model, int number);

  /// Returns the last time, in seconds.
  double duration() const { return duration_; }
  /// Returns whether a channel moves, turns or scales the node.
  bool moves(int node) const {
    const auto target = targets_.lower_bound({node, Path::kTranslation});
    return target != targets_.end() && target->first == node;
  }
  /// Returns the number of channels with other targets: morph targets, or targets defined by
  /// extensions.
  std::size_t others() const { return others_; }

  /// Sets the nodes' translations, rotations and scales at a time. Before a channel's first time
  /// and after its last, its first and last value apply.
  void pose(std::vector<tinygltf::Node>& nodes, double time) const;

 private:
  enum class Path : std::uint8_t { kTranslation, kRotation, kScale };
  enum class Interpolation : std::uint8_t { kStep, kLinear, kCubic };
  using Value = std::array<double, 4>;  // a rotation's x, y, z, w; other paths have three numbers

  struct Channel {
    int node;
    Path path;
    Interpolation interpolation;
    std::vector<double> times;
    std::vector<Value> values;  // for kCubic: in-tangent, value and out-tangent of each time
  };

  static Value value_at(const Channel& channel, double time);

  std::vector<Channel> channels_;
  std::set<std::pair<int, Path>> targets_;
  double duration_ = 0.0;
  std::size_t others_ = 0;
};

}  // namespace beambench::scenes::mesh
