#include "harness/cluster/beam_shape.hpp"

namespace beambench::cluster {
namespace {

template <class Values>
std::size_t read_count(const Values& values, ByteReader& reader) {
  const std::size_t count = reader.get<std::uint8_t>();
  if (count > values.capacity()) throw ProtocolError("a beam has too many corners or cuts");
  return count;
}

}  // namespace

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

}  // namespace beambench::cluster
