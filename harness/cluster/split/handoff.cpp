#include "harness/cluster/split/handoff.hpp"

#include "harness/cluster/tasks.hpp"

namespace beambench::cluster {
namespace {

enum class Kind : std::uint8_t { kBeam, kRay };

RayHandoff read_ray(ByteReader& reader) {
  RayHandoff ray{};
  ray.cell = reader.get<std::uint32_t>();
  ray.sample = reader.get<std::uint32_t>();
  ray.t = reader.get<double>();
  ray.best_t = reader.get<float>();
  ray.best = reader.get<scenes::PrimitiveId>();
  return ray;
}

}  // namespace

void write_handoff(const BeamHandoff& beam, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(Kind::kBeam));
  writer.put(beam.cell);
  write_crossing(beam.face, writer);
  write_shape(beam.beam, writer);
}

void write_handoff(const RayHandoff& ray, Bytes& bytes) {
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint8_t>(Kind::kRay));
  writer.put(ray.cell);
  writer.put(ray.sample);
  writer.put(ray.t);
  writer.put(ray.best_t);
  writer.put(ray.best);
}

Handoff read_handoff(ByteReader& reader, const accel::beam::EyeView& view) {
  switch (static_cast<Kind>(reader.get<std::uint8_t>())) {
    case Kind::kBeam: {
      BeamHandoff beam{};
      beam.cell = reader.get<std::uint32_t>();
      beam.face = read_crossing(view.grid(), reader);
      read_shape(reader, view, beam.beam);
      return beam;
    }
    case Kind::kRay:
      return read_ray(reader);
  }
  throw ProtocolError("a handoff is neither a beam nor a ray");
}

}  // namespace beambench::cluster
