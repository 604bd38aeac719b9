#include "harness/thesis/cluster/tasks.hpp"

#include <algorithm>
#include <bit>
#include <tuple>

#include "scenes/base/error.hpp"

namespace beambench::cluster {
namespace {

template <class Values>
std::size_t read_count(const Values& values, ByteReader& reader) {
  const std::size_t count = reader.get<std::uint8_t>();
  if (count > values.capacity()) throw ProtocolError("a beam has too many corners or cuts");
  return count;
}

// takes the place of a beam's kind
constexpr std::uint8_t kBlock = 255;
constexpr std::uint8_t kTile = 254;

void write_part(std::uint8_t kind, const accel::beam::PixelRect& part, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(kind);
  for (const int number : {part.left, part.top, part.width, part.height}) {
    writer.put(static_cast<std::uint16_t>(number));
  }
}

accel::beam::PixelRect read_part(ByteReader& reader) {
  accel::beam::PixelRect part{};
  for (int* number : {&part.left, &part.top, &part.width, &part.height}) {
    *number = reader.get<std::uint16_t>();
  }
  return part;
}

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

std::uint64_t leaf_code(const accel::octree::Octree& octree, const glm::ivec3& corner,
                        std::int32_t size) {
  std::uint64_t code = 1;
  for (std::int32_t half = octree.grid().cells.x / 2; half >= size; half /= 2) {
    for (const int axis : {2, 1, 0}) code = 2 * code + ((corner[axis] & half) != 0 ? 1 : 0);
  }
  return code;
}

accel::octree::OctreeCursor find_leaf(const accel::octree::Octree& octree, std::uint64_t code) {
  accel::octree::OctreeCursor cursor(octree);
  for (auto shift = static_cast<int>(std::bit_width(code)) - 1;
       shift > 0 && !cursor.node().is_leaf();) {
    shift -= 3;
    if (shift < 0) break;
    const std::uint64_t octant = code >> static_cast<unsigned>(shift);
    glm::ivec3 corner = cursor.corner();
    for (int axis = 0; axis < 3; ++axis) {
      if (((octant >> static_cast<unsigned>(axis)) & 1) != 0) corner[axis] += cursor.size() / 2;
    }
    cursor.enter_child(corner);
  }
  if (!cursor.node().is_leaf() || leaf_code(octree, cursor.corner(), cursor.size()) != code) {
    throw ProtocolError("a beam refers to a leaf that is not in this process's octree");
  }
  return cursor;
}

void write_crossing(const accel::beam::Crossing& crossing, ByteWriter& writer) {
  writer.put(static_cast<std::uint8_t>(2 * crossing.axis + (crossing.side > 0 ? 1 : 0)));
  writer.put(crossing.index);
}

accel::beam::Crossing read_crossing(const accel::CellGrid& grid, ByteReader& reader) {
  const auto face = reader.get<std::uint8_t>();
  const auto index = reader.get<std::int32_t>();
  if (face >= 6 || index < 0 || index > grid.cells.x) {
    throw ProtocolError("a beam is cut by planes that are not in this process's octree");
  }
  return {index, static_cast<std::int16_t>(face / 2),
          static_cast<std::int16_t>(face % 2 == 1 ? 1 : -1)};
}

void write_shape(const accel::beam::Beam& beam, ByteWriter& writer) {
  writer.put(static_cast<std::uint8_t>(beam.outline.size()));
  for (const glm::dvec2& corner : beam.outline) {
    writer.put(corner.x);
    writer.put(corner.y);
  }
  writer.put(static_cast<std::uint8_t>(beam.cuts.size()));
  for (const accel::beam::BeamCut& cut : beam.cuts) {
    write_crossing(cut.first, writer);
    write_crossing(cut.second, writer);
  }
}

void read_shape(ByteReader& reader, const accel::beam::EyeView& view, accel::beam::Beam& beam) {
  for (std::size_t left = read_count(beam.outline, reader); left > 0; --left) {
    const auto x = reader.get<double>();
    beam.outline.push_back({x, reader.get<double>()});
  }
  for (std::size_t left = read_count(beam.cuts, reader); left > 0; --left) {
    const accel::beam::Crossing first = read_crossing(view.grid(), reader);
    const accel::beam::Crossing second = read_crossing(view.grid(), reader);
    beam.cuts.push_back({first, second, view.line_before(first, second)});
  }
  if (beam.outline.empty()) throw ProtocolError("a beam without corners");
}

void write_task(const BeamTask& task, const accel::octree::Octree& octree, Bytes& bytes) {
  const accel::beam::Beam& beam = task.beam;
  ByteWriter writer(bytes);
  writer.put(task.kind);
  writer.put(leaf_code(octree, beam.corner, beam.size));
  write_shape(beam, writer);
}

void write_task(const BlockTask& task, Bytes& bytes) { write_part(kBlock, task, bytes); }
void write_task(const TileTask& task, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(kTile);
  writer.put(std::tie(task.first, task.count, task.size));
}

std::optional<TileTask> read_tiles(std::span<const std::byte> bytes) {
  ByteReader reader(bytes);
  if (reader.get<std::uint8_t>() != kTile) return std::nullopt;
  TileTask tiles{};
  reader.get(std::tie(tiles.first, tiles.count, tiles.size));
  return tiles;
}

std::variant<BeamTask, BlockTask, TileTask> read_task(std::span<const std::byte> bytes,
                                                      const accel::octree::Octree& octree,
                                                      const accel::beam::EyeView& view) {
  ByteReader reader(bytes);
  const auto kind = reader.get<std::uint8_t>();
  if (kind == kBlock) return BlockTask{read_part(reader)};
  if (const auto tiles = read_tiles(bytes)) return *tiles;
  return read_beam(kind, reader, octree, view);
}

std::optional<BeamTask::Kind> end_of(const accel::beam::BeamStep& step,
                                     const accel::beam::BeamTracer& tracer,
                                     const accel::PrimaryRays& rays) {
  if (step.kind == accel::BeamKind::kLeaving) return std::nullopt;
  if (step.kind == accel::BeamKind::kOccupied) return BeamTask::Kind::kTestLeaf;
  if (step.beam.crowded()) return BeamTask::Kind::kCrowded;
  const auto least = static_cast<double>(tracer.options().handover);
  const double samples = accel::beam::area(step.beam.outline) * static_cast<double>(rays.count());
  return least > 0.0 && samples < least ? std::optional(BeamTask::Kind::kSmall) : std::nullopt;
}

void require_tasks(const accel::beam::BeamTracer& tracer) {
  if (tracer.options().continue_with_rays) return;
  throw InputError(
      "continue=beams cannot be distributed: beams behind a leaf would have to be sent back as a "
      "beam; use continue=rays");
}

BeamSource::BeamSource(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays)
    : tracer_(&tracer), rays_(&rays), view_(tracer.octree().grid(), rays) {
  require_tasks(tracer);
  accel::beam::begin_beams(tracer.octree(), view_, view_.screen(), queue_);
}

bool BeamSource::next(Bytes& task) {
  accel::beam::BeamStep step;
  while (!queue_.waiting.empty()) {
    queue_.waiting.pop(step);
    if (const auto kind = end_of(step, *tracer_, *rays_)) {
      write_task({*kind, step.beam}, tracer_->octree(), task);
      return true;
    }
    if (step.kind == accel::BeamKind::kLeaving) continue;
    accel::beam::continue_beam(tracer_->octree(), view_, step.beam, queue_);
  }
  return false;
}

BlockSource::BlockSource(int width, int height, int size)
    : width_(width), height_(height), size_(size) {}

bool BlockSource::next(Bytes& task) {
  if (top_ >= height_) return false;
  write_task(
      BlockTask{{left_, top_, std::min(size_, width_ - left_), std::min(size_, height_ - top_)}},
      task);
  left_ += size_;
  if (left_ >= width_) {
    left_ = 0;
    top_ += size_;
  }
  return true;
}

}  // namespace beambench::cluster
