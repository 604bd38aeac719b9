#include "harness/cluster/task_message.hpp"

#include "harness/cluster/beam_shape.hpp"
#include "harness/cluster/leaf_code.hpp"

namespace beambench::cluster {
namespace {

constexpr std::uint8_t kBlock = 255;  // in the place of a beam's kind

BeamTask read_beam(std::uint8_t kind, ByteReader& reader, const accel::octree::Octree& octree,
                   const accel::beam::EyeView& view) {
  if (kind > static_cast<std::uint8_t>(BeamTask::Kind::kCrowded)) {
    throw ProtocolError("a task of an unknown kind");
  }
  BeamTask task{static_cast<BeamTask::Kind>(kind), {}};
  accel::beam::Beam& beam = task.beam;
  const accel::octree::OctreeCursor leaf = find_leaf(octree, reader.get<std::uint64_t>());
  beam.node = leaf.index();
  beam.corner = leaf.corner();
  beam.size = leaf.size();
  read_shape(reader, view, beam);
  return task;
}

}  // namespace

void write_task(const BeamTask& task, const accel::octree::Octree& octree, Bytes& bytes) {
  const accel::beam::Beam& beam = task.beam;
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(task.kind));
  writer.put(leaf_code(octree, beam.corner, beam.size));
  write_shape(beam, writer);
}

void write_task(const BlockTask& task, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(kBlock);
  for (const int number : {task.left, task.top, task.width, task.height}) {
    writer.put(static_cast<std::uint16_t>(number));
  }
}

std::variant<BeamTask, BlockTask> read_task(std::span<const std::byte> bytes,
                                            const accel::octree::Octree& octree,
                                            const accel::beam::EyeView& view) {
  ByteReader reader(bytes);
  const auto kind = reader.get<std::uint8_t>();
  if (kind != kBlock) return read_beam(kind, reader, octree, view);
  BlockTask block{};
  for (int* number : {&block.left, &block.top, &block.width, &block.height}) {
    *number = reader.get<std::uint16_t>();
  }
  return block;
}

}  // namespace beambench::cluster
