#pragma once
// The places where the rays of a wave meet surfaces, and the light on them, stored by component so
// that SIMD computes several at once. Operations and their order match those of glm::dvec3, so
// results have the same bits on every instruction set.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::render {

/// Numbers for whole registers, with padding after the last one.
class Doubles {
 public:
  explicit Doubles(std::size_t count) : values_((count + kLanes - 1) / kLanes * kLanes) {}

  double* data() { return values_.data(); }
  const double* data() const { return values_.data(); }
  double& operator[](std::size_t i) { return values_[i]; }
  double operator[](std::size_t i) const { return values_[i]; }

 private:
  static constexpr std::size_t kLanes = 8;
  std::vector<double> values_;
};

/// Vectors, stored by component.
class Vectors {
 public:
  explicit Vectors(std::size_t count) : x(count), y(count), z(count) {}

  void set(std::size_t i, const glm::dvec3& vector) {
    x[i] = vector.x;
    y[i] = vector.y;
    z[i] = vector.z;
  }
  glm::dvec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }

  Doubles x;
  Doubles y;
  Doubles z;
};

/// Places on surfaces at the ends of rays of one depth.
struct Places {
  explicit Places(std::size_t count)
      : size(count),
        point(count),
        beside(count),
        lift(count),
        incoming(count),
        geometric(count),
        shading(count) {}

  std::size_t size;
  Vectors point;
  Vectors beside;     ///< `lift` in front of the surface: origins of rays
  Doubles lift;       ///< `accel::surface_lift`, or `mirror_lift` on a planar mirror
  Vectors incoming;   ///< the ray's direction, of unit length
  Vectors geometric;  ///< unit normals on the side of the ray
  Vectors shading;
};

/// The angles of a light at each place, assuming that nothing is in between.
struct LightAngles {
  explicit LightAngles(std::size_t count) : cosine(count), gleam(count), is_before(count) {}

  Doubles cosine;     ///< of the angle between the shading normal and the direction to the light
  Doubles gleam;      ///< of the angle between the eye and the mirror direction of the light
  Doubles is_before;  ///< 1 if the light is in front of the surface, by both normals
};

/// The computations for one instruction set.
struct PlaceKernels {
  /// Computes the members of `Places` from points, lifts, and directions and normals of any length
  /// on either side; an undefined normal is replaced by the direction opposite to the ray.
  void (*complete)(Places& places);
  void (*find_angles)(const Places& places, const glm::dvec3& light, LightAngles& angles);
};

/// Returns the kernels for the best of Highway's `targets` that this machine supports. The call
/// takes microseconds.
const PlaceKernels& place_kernels(std::int64_t targets);

}  // namespace beambench::render
