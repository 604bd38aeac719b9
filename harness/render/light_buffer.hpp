#pragma once
// Shadows from a list: what lies in each direction from a light, found out beforehand.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// The light buffer (Haines and Greenberg, "The light buffer: a shadow-testing accelerator", IEEE
/// CG&A 6(9), 1986): the faces of a cube about a light are divided into cells, and each cell lists
/// the primitives that may be seen through it, the nearest first. A shadow ray's cell holds all
/// primitives that it can meet, so the answer is that of a search of all primitives.
class LightBuffer {
 public:
  /// `cells` along an edge of the cube, at least 1. The scene must outlive the buffer.
  LightBuffer(const scenes::Scene& scene, const glm::vec3& light, int cells);

  enum class Answer {
    kFree,         ///< nothing before the light
    kHidden,       ///< something opaque
    kTransparent,  ///< something transparent, nothing opaque: what comes through must be followed
  };
  /// What lies on a shadow ray: `to_light` begins at a point and has the light at t = 1. `tests`
  /// grows by the ray-primitive tests made.
  Answer ask(const accel::Ray& to_light, std::uint64_t& tests) const;

  std::size_t memory_bytes() const;

 private:
  struct Entry {
    double near;  ///< the least distance from the light
    scenes::PrimitiveId primitive;
  };
  std::size_t cell_of(const glm::dvec3& direction) const;

  const scenes::Scene* scene_;
  glm::dvec3 light_;
  int cells_;
  std::vector<std::uint32_t> first_;  ///< by cell, and one more: its first entry
  std::vector<Entry> entries_;
};

}  // namespace beambench::render
