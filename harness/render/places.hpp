#pragma once
// Where the rays of a wave meet surfaces, and how a light shines on these places: by component, so
// that several are computed at once by SIMD. The operations and their order are those of
// glm::dvec3, so that the results are the same bits on every instruction set.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::render {

/// Numbers for whole registers: there is room for some more behind the last one.
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

/// Vectors, by component.
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

/// Places on surfaces, where rays of one depth end.
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
  Vectors beside;     ///< `lift` before the surface: where rays begin
  Doubles lift;       ///< `accel::surface_lift`, or `mirror_lift` on a planar mirror
  Vectors incoming;   ///< the ray's direction, of unit length
  Vectors geometric;  ///< unit normals on the side of the ray
  Vectors shading;
};

/// How a light shines on each place, if nothing is between.
struct LightAngles {
  explicit LightAngles(std::size_t count) : cosine(count), gleam(count), is_before(count) {}

  Doubles cosine;     ///< of the angle between the shading normal and the direction to the light
  Doubles gleam;      ///< of the angle between the eye and where a mirror would send the light
  Doubles is_before;  ///< 1 where the light is before the surface, by both normals; 0 elsewhere
};

/// The computations for one instruction set.
struct PlaceKernels {
  /// Computes all that `Places` describes from points, lifts, directions of any length and normals
  /// of any length on either side; a normal without a direction is turned against the ray.
  void (*complete)(Places& places);
  void (*find_angles)(const Places& places, const glm::dvec3& light, LightAngles& angles);
};

/// Those for the best of Highway's `targets` that this machine has. Asking for them takes
/// microseconds.
const PlaceKernels& place_kernels(std::int64_t targets);

}  // namespace beambench::render
