#include "harness/cluster/task_message.hpp"

#include "harness/cluster/leaf_code.hpp"

namespace beambench {
namespace {

constexpr std::uint8_t kBlock = 255;  // in the place of a beam's kind

void write_crossing(const Crossing& crossing, ByteWriter& writer) {
  writer.put(static_cast<std::uint8_t>(2 * crossing.axis + (crossing.side > 0 ? 1 : 0)));
  writer.put(crossing.index);
}

Crossing read_crossing(const Octree& octree, ByteReader& reader) {
  const auto face = reader.get<std::uint8_t>();
  const auto index = reader.get<std::int32_t>();
  if (face >= 6 || index < 0 || index > octree.grid().cells.x) {
    throw ProtocolError("a beam is cut by planes that are not in this process's octree");
  }
  return {index, static_cast<std::int16_t>(face / 2),
          static_cast<std::int16_t>(face % 2 == 1 ? 1 : -1)};
}

template <class Values>
std::size_t read_count(const Values& values, ByteReader& reader) {
  const std::size_t count = reader.get<std::uint8_t>();
  if (count > values.capacity()) throw ProtocolError("a beam has too many corners or cuts");
  return count;
}

BeamTask read_beam(std::uint8_t kind, ByteReader& reader, const Octree& octree,
                   const EyeView& view) {
  if (kind > static_cast<std::uint8_t>(BeamTask::Kind::kCrowded)) {
    throw ProtocolError("a task of an unknown kind");
  }
  BeamTask task{static_cast<BeamTask::Kind>(kind), {}};
  Beam& beam = task.beam;
  const OctreeCursor leaf = find_leaf(octree, reader.get<std::uint64_t>());
  beam.node = leaf.index();
  beam.corner = leaf.corner();
  beam.size = leaf.size();
  for (std::size_t left = read_count(beam.outline, reader); left > 0; --left) {
    const auto x = reader.get<double>();
    beam.outline.push_back({x, reader.get<double>()});
  }
  for (std::size_t left = read_count(beam.cuts, reader); left > 0; --left) {
    const Crossing first = read_crossing(octree, reader);
    const Crossing second = read_crossing(octree, reader);
    beam.cuts.push_back({first, second, view.line_before(first, second)});
  }
  if (beam.outline.empty()) throw ProtocolError("a beam without corners");
  return task;
}

}  // namespace

void write_task(const BeamTask& task, const Octree& octree, Bytes& bytes) {
  const Beam& beam = task.beam;
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(task.kind));
  writer.put(leaf_code(octree, beam.corner, beam.size));
  writer.put(static_cast<std::uint8_t>(beam.outline.size()));
  for (const glm::dvec2& corner : beam.outline) {
    writer.put(corner.x);
    writer.put(corner.y);
  }
  writer.put(static_cast<std::uint8_t>(beam.cuts.size()));
  for (const BeamCut& cut : beam.cuts) {
    write_crossing(cut.first, writer);
    write_crossing(cut.second, writer);
  }
}

void write_task(const BlockTask& task, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(kBlock);
  for (const int number : {task.left, task.top, task.width, task.height}) {
    writer.put(static_cast<std::uint16_t>(number));
  }
}

std::variant<BeamTask, BlockTask> read_task(std::span<const std::byte> bytes, const Octree& octree,
                                            const EyeView& view) {
  ByteReader reader(bytes);
  const auto kind = reader.get<std::uint8_t>();
  if (kind != kBlock) return read_beam(kind, reader, octree, view);
  BlockTask block{};
  for (int* number : {&block.left, &block.top, &block.width, &block.height}) {
    *number = reader.get<std::uint16_t>();
  }
  return block;
}

}  // namespace beambench
