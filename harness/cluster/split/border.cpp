#include "harness/cluster/split/border.hpp"

#include "harness/cluster/beam_shape.hpp"

namespace beambench::cluster {
namespace {

enum class Kind : std::uint8_t { kBeam, kRay };

CrossingRay read_ray(ByteReader& reader) {
  CrossingRay ray{};
  ray.cell = reader.get<std::uint32_t>();
  ray.sample = reader.get<std::uint32_t>();
  ray.t = reader.get<double>();
  ray.best_t = reader.get<float>();
  ray.best = reader.get<scenes::PrimitiveId>();
  return ray;
}

}  // namespace

void write_traveler(const CrossingBeam& beam, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(Kind::kBeam));
  writer.put(beam.cell);
  write_crossing(beam.face, writer);
  write_shape(beam.beam, writer);
}

void write_traveler(const CrossingRay& ray, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(Kind::kRay));
  writer.put(ray.cell);
  writer.put(ray.sample);
  writer.put(ray.t);
  writer.put(ray.best_t);
  writer.put(ray.best);
}

Traveler read_traveler(ByteReader& reader, const accel::beam::EyeView& view) {
  switch (static_cast<Kind>(reader.get<std::uint8_t>())) {
    case Kind::kBeam: {
      CrossingBeam beam{};
      beam.cell = reader.get<std::uint32_t>();
      beam.face = read_crossing(view.grid(), reader);
      read_shape(reader, view, beam.beam);
      return beam;
    }
    case Kind::kRay:
      return read_ray(reader);
  }
  throw ProtocolError("neither a beam nor a ray crosses the border");
}

}  // namespace beambench::cluster
