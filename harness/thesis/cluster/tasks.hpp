#pragma once
// The tasks of consumers (beams, blocks or tiles of the image): their sources and their encoding.

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/sample_lattice.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Returns the locational code of a node (thesis, section 6.2.2, "some code"; Gargantini 1982): the
/// octants on the path from the root, three bits each, after a leading 1.
std::uint64_t leaf_code(const accel::octree::Octree& octree, const glm::ivec3& corner,
                        std::int32_t size);

/// Returns the leaf with that code. Throws ProtocolError if the octree does not contain it.
accel::octree::OctreeCursor find_leaf(const accel::octree::Octree& octree, std::uint64_t code);

/// Writes a plane of the cells: five bytes.
void write_crossing(const accel::beam::Crossing& crossing, ByteWriter& writer);
/// Reads a plane of the cells. Throws ProtocolError if the grid does not have that plane.
accel::beam::Crossing read_crossing(const accel::CellGrid& grid, ByteReader& reader);

/// Writes the outline and the cuts of a beam. Only the planes of the cuts are written, because the
/// lines follow from the planes.
void write_shape(const accel::beam::Beam& beam, ByteWriter& writer);
/// Reads outline and cuts, bit for bit. Throws ProtocolError for other bytes.
void read_shape(ByteReader& reader, const accel::beam::EyeView& view, accel::beam::Beam& beam);

/// A beam whose samples become rays.
struct BeamTask {
  enum class Kind : std::uint8_t {
    kTestLeaf,  ///< it is at an occupied leaf
    kSmall,     ///< it has few samples
    kCrowded    ///< it cannot be divided further
  };
  Kind kind;
  accel::beam::Beam beam;
};

/// Returns why a beam ends and its samples become rays; nothing if it continues or leaves the
/// scene.
std::optional<BeamTask::Kind> end_of(const accel::beam::BeamStep& step,
                                     const accel::beam::BeamTracer& tracer,
                                     const accel::PrimaryRays& rays);

/// Traces the samples of a beam that has ended.
template <class Painter>
void paint(BeamTask::Kind end, const accel::beam::Beam& beam, Painter& painter) {
  if (end == BeamTask::Kind::kTestLeaf) {
    painter.test_leaf(beam);
  } else {
    painter.hand_over(beam, end == BeamTask::Kind::kCrowded ? accel::beam::RayReason::kCrowded
                                                            : accel::beam::RayReason::kHandover);
  }
}

/// Pixels traced by individual rays.
struct BlockTask : accel::beam::PixelRect {};

/// Tiles traced by beams, which the tracing process makes itself, starting at the root: a range of
/// `TileOrder` that starts at `first`.
struct TileTask {
  std::uint32_t first;
  std::uint32_t count;
  std::uint16_t size;  ///< pixels along a side
};

/// Encode a task. The leaf is identified by its code: a beam takes about 150 bytes.
void write_task(const BeamTask& task, const accel::octree::Octree& octree, Bytes& bytes);
void write_task(const BlockTask& task, Bytes& bytes);
void write_task(const TileTask& task, Bytes& bytes);

/// Reads a range of tiles; returns nothing for other tasks. Throws ProtocolError if the task is
/// truncated.
std::optional<TileTask> read_tiles(std::span<const std::byte> bytes);

/// Reads a task; the same octree yields the same beam, bit for bit. Throws ProtocolError for other
/// bytes.
std::variant<BeamTask, BlockTask, TileTask> read_task(std::span<const std::byte> bytes,
                                                      const accel::octree::Octree& octree,
                                                      const accel::beam::EyeView& view);

/// Throws InputError if the tracer continues beams behind occupied leaves, because they would have
/// to be sent back.
void require_tasks(const accel::beam::BeamTracer& tracer);

/// The traversal of the beams (thesis, section 6.2.2): beams in empty leaves continue; beams that
/// leave the scene end, because the image starts as background; and beams at occupied leaves become
/// the tasks.
class BeamSource : public TaskSource {
 public:
  /// Both arguments must outlive this object. Throws what `require_tasks` throws.
  BeamSource(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays);

  bool next(Bytes& task) override;

 private:
  const accel::beam::BeamTracer* tracer_;
  const accel::PrimaryRays* rays_;
  accel::beam::EyeView view_;
  accel::beam::BeamQueue queue_;
};

/// Blocks of the image, row by row: the tasks of ray tracers without beams.
class BlockSource : public TaskSource {
 public:
  /// Blocks have `size` x `size` pixels, fewer at the right and lower border.
  BlockSource(int width, int height, int size);

  bool next(Bytes& task) override;

 private:
  int width_;
  int height_;
  int size_;
  int left_ = 0;
  int top_ = 0;
};

}  // namespace beambench::cluster
