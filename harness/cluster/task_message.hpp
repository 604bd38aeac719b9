#pragma once
// What a consumer is asked to do: a beam, or a block of the image.

#include <span>
#include <variant>

#include "accel/beam/beam.hpp"
#include "accel/octree/octree.hpp"
#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// A beam that has come to where rays take over.
struct BeamTask {
  /// What is to become of it.
  enum class Kind : std::uint8_t {
    kTestLeaf,  ///< it is at an occupied leaf
    kSmall,     ///< it has few samples: rays from here on
    kCrowded    ///< it can be divided no more: rays from here on
  };
  Kind kind;
  accel::beam::Beam beam;
};

/// Pixels from (left, top), traced by individual rays.
struct BlockTask {
  int left;
  int top;
  int width;
  int height;
};

/// As bytes. The leaf is named by its code: a beam takes about 150 bytes.
void write_task(const BeamTask& task, const accel::octree::Octree& octree, Bytes& bytes);
void write_task(const BlockTask& task, Bytes& bytes);

/// Back again; the same octree gives the same beam bit for bit. Throws ProtocolError for what is no
/// task.
std::variant<BeamTask, BlockTask> read_task(std::span<const std::byte> bytes,
                                            const accel::octree::Octree& octree,
                                            const accel::beam::EyeView& view);

}  // namespace beambench::cluster
