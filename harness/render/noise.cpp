#include "harness/render/noise.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace beambench::render {
namespace {

using Lattice = glm::vec<3, std::int64_t>;

/// Mixes the three coordinates (multiplications and shifts as in MurmurHash3's finalizer).
std::uint64_t hash(const Lattice& at) {
  std::uint64_t bits = static_cast<std::uint64_t>(at.x) * 0x9E3779B97F4A7C15ULL +
                       static_cast<std::uint64_t>(at.y) * 0xC2B2AE3D27D4EB4FULL +
                       static_cast<std::uint64_t>(at.z) * 0x165667B19E3779F9ULL;
  bits ^= bits >> 33U;
  bits *= 0xFF51AFD7ED558CCDULL;
  bits ^= bits >> 33U;
  bits *= 0xC4CEB9FE1A85EC53ULL;
  return bits ^ (bits >> 33U);
}

/// Toward the middles of a cube's edges, from its center.
double gradient_at(const Lattice& corner, const glm::dvec3& offset) {
  static constexpr std::array<std::array<int, 3>, 12> kDirections{{{1, 1, 0},
                                                                   {-1, 1, 0},
                                                                   {1, -1, 0},
                                                                   {-1, -1, 0},
                                                                   {1, 0, 1},
                                                                   {-1, 0, 1},
                                                                   {1, 0, -1},
                                                                   {-1, 0, -1},
                                                                   {0, 1, 1},
                                                                   {0, -1, 1},
                                                                   {0, 1, -1},
                                                                   {0, -1, -1}}};
  const auto& to = kDirections[hash(corner) % kDirections.size()];
  return to[0] * offset.x + to[1] * offset.y + to[2] * offset.z;
}

/// 6 x^5 - 15 x^4 + 10 x^3: no step in the second derivative.
double faded(double x) { return x * x * x * (x * (x * 6.0 - 15.0) + 10.0); }

}  // namespace

double gradient_noise(const glm::dvec3& point) {
  const glm::dvec3 floor = glm::floor(point);
  const Lattice cell(floor);
  const glm::dvec3 inside = point - floor;
  const glm::dvec3 part(faded(inside.x), faded(inside.y), faded(inside.z));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Lattice step(corner % 2, corner / 2 % 2, corner / 4);
    const double weight = (step.x == 1 ? part.x : 1.0 - part.x) *
                          (step.y == 1 ? part.y : 1.0 - part.y) *
                          (step.z == 1 ? part.z : 1.0 - part.z);
    sum += weight * gradient_at(cell + step, inside - glm::dvec3(step));
  }
  return sum;
}

double fractal_noise(const glm::dvec3& point, int octaves) {
  double sum = 0.0;
  double size = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += size * gradient_noise(point / size);
    size *= 0.5;
  }
  return sum;
}

double turbulence(const glm::dvec3& point, int octaves) {
  double sum = 0.0;
  double size = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += size * std::abs(gradient_noise(point / size));
    size *= 0.5;
  }
  return sum;
}

}  // namespace beambench::render
