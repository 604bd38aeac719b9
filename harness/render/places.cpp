#include "harness/render/places.hpp"

#include <limits>

#include "accel/core/pick_target.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "harness/render/places.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace beambench::render::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<Tag>;

inline Lanes set(double value) { return hn::Set(Tag(), value); }

/// Several glm::dvec3, processed together.
struct Vector {
  Lanes x, y, z;
};

inline Vector load(const Vectors& from, std::size_t i) {
  const Tag tag;
  return {hn::LoadU(tag, from.x.data() + i), hn::LoadU(tag, from.y.data() + i),
          hn::LoadU(tag, from.z.data() + i)};
}
inline void store(const Vector& vector, Vectors& to, std::size_t i) {
  const Tag tag;
  hn::StoreU(vector.x, tag, to.x.data() + i);
  hn::StoreU(vector.y, tag, to.y.data() + i);
  hn::StoreU(vector.z, tag, to.z.data() + i);
}
inline Lanes dot(const Vector& a, const Vector& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
inline Vector scaled(const Vector& a, Lanes by) {
  return {hn::Mul(a.x, by), hn::Mul(a.y, by), hn::Mul(a.z, by)};
}
inline Vector sum(const Vector& a, const Vector& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
inline Vector difference(const Vector& a, const Vector& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
inline Vector opposite(const Vector& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
inline Vector if_then_else(hn::Mask<Tag> mask, const Vector& a, const Vector& b) {
  return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y),
          hn::IfThenElse(mask, a.z, b.z)};
}
inline Vector normalized(const Vector& a) {
  return scaled(a, hn::Div(set(1.0), hn::Sqrt(dot(a, a))));
}

/// Returns the normal on the side from which the ray comes.
inline Vector facing(const Vector& normal, const Vector& direction, const Vector& incoming) {
  const Lanes length = hn::Sqrt(dot(normal, normal));
  const auto is_direction = hn::And(hn::Gt(length, set(0.0)),
                                    hn::Lt(length, set(std::numeric_limits<double>::infinity())));
  const Vector unit = scaled(normal, hn::Div(set(1.0), length));
  const Vector turned = if_then_else(hn::Gt(dot(unit, direction), set(0.0)), opposite(unit), unit);
  // An object smaller than the rounding of t can be hit at its very center.
  return if_then_else(is_direction, turned, opposite(incoming));
}

void complete(Places& places) {
  for (std::size_t i = 0; i < places.size; i += hn::Lanes(Tag())) {
    const Vector point = load(places.point, i);
    const Vector direction = load(places.incoming, i);
    const Vector incoming = normalized(direction);
    const Vector geometric = facing(load(places.geometric, i), direction, incoming);
    store(incoming, places.incoming, i);
    store(geometric, places.geometric, i);
    store(facing(load(places.shading, i), direction, incoming), places.shading, i);
    store(sum(point, scaled(geometric, hn::LoadU(Tag(), places.lift.data() + i))), places.beside,
          i);
  }
}

void find_angles(const Places& places, const glm::dvec3& light, LightAngles& angles) {
  const Tag tag;
  const Vector position{set(light.x), set(light.y), set(light.z)};
  for (std::size_t i = 0; i < places.size; i += hn::Lanes(tag)) {
    const Vector offset = difference(position, load(places.beside, i));
    const Vector shading = load(places.shading, i);
    const auto before = hn::And(hn::Gt(dot(offset, load(places.geometric, i)), set(0.0)),
                                hn::Gt(dot(offset, shading), set(0.0)));
    const Vector to_light = normalized(offset);
    hn::StoreU(dot(to_light, shading), tag, angles.cosine.data() + i);
    // as in accel::mirrored
    const Vector from_light = opposite(to_light);
    const Vector mirrored =
        difference(from_light, scaled(shading, hn::Mul(set(2.0), dot(from_light, shading))));
    hn::StoreU(dot(mirrored, opposite(load(places.incoming, i))), tag, angles.gleam.data() + i);
    hn::StoreU(hn::IfThenElseZero(before, set(1.0)), tag, angles.is_before.data() + i);
  }
}

const PlaceKernels& kernels_of_places() {
  static constexpr PlaceKernels kKernels{complete, find_angles};
  return kKernels;
}

}  // namespace beambench::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::render {

HWY_EXPORT(kernels_of_places);

const PlaceKernels& place_kernels(std::int64_t targets) {
  return accel::pick_target(HWY_DISPATCH_TABLE(kernels_of_places), targets)();
}

}  // namespace beambench::render
#endif
