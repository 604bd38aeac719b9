#include "harness/render/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace beambench::render {
namespace {

using Lattice = glm::vec<3, std::int64_t>;

constexpr std::uint64_t kHashX = 0x9E3779B97F4A7C15ULL;
constexpr std::uint64_t kHashY = 0xC2B2AE3D27D4EB4FULL;
constexpr std::uint64_t kHashZ = 0x165667B19E3779F9ULL;

/// Mixes three coordinates that have already been multiplied (multiplications and shifts as in
/// MurmurHash3's finalizer).
std::uint64_t mixed(std::uint64_t bits) {
  bits ^= bits >> 33U;
  bits *= 0xFF51AFD7ED558CCDULL;
  bits ^= bits >> 33U;
  bits *= 0xC4CEB9FE1A85EC53ULL;
  return bits ^ (bits >> 33U);
}

/// Gradients toward the middles of a cube's edges, from its center.
constexpr std::array<glm::dvec3, 12> kGradients{{{1, 1, 0},
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

/// Returns 6 x^5 - 15 x^4 + 10 x^3, which has a continuous second derivative.
double faded(double x) { return x * x * x * (x * (x * 6.0 - 15.0) + 10.0); }

using glm::dvec3;

/// The ratio of the scene's longest side to the largest feature of a texture.
constexpr double kFeatures = 12.0;

/// Returns the sum over octaves of `of` applied to noise with twice the frequency and half the
/// amplitude.
template <class Of>
double over_octaves(const dvec3& point, int octaves, Of of) {
  double sum = 0.0;
  double size = 1.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += size * of(gradient_noise(point / size));
    size *= 0.5;
  }
  return sum;
}

double smooth_step(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// Layers bent by turbulence, with thin dark veins between them (Perlin 1985).
dvec3 marble(const dvec3& p, const dvec3& stone, const dvec3& vein) {
  const double layer = std::sin(2.0 * p.x + 1.0 * p.y + 6.0 * turbulence(p, 5));
  const double vein_share = std::pow(0.5 + 0.5 * layer, 6.0);
  const double cloud = 0.12 * fractal_noise(0.7 * p, 3);
  return glm::clamp(glm::mix(stone * (1.0 + cloud), vein, vein_share), 0.0, 1.0);
}

/// Grains of two kinds of stone in a third kind.
dvec3 granite(const dvec3& p, const dvec3& mean) {
  const double dark = smooth_step(0.05, 0.25, fractal_noise(6.0 * p, 3));
  const double light = smooth_step(0.1, 0.3, fractal_noise(5.0 * p + dvec3(17.0), 3));
  dvec3 color = glm::mix(mean, 0.35 * mean, dark);
  color = glm::mix(color, glm::min(1.45 * mean, dvec3(1.0)), light);
  return color * (1.0 + 0.15 * gradient_noise(14.0 * p));
}

/// Rings about a leaning axis, and grain along it.
dvec3 wood(const dvec3& p, const dvec3& early, const dvec3& late) {
  const dvec3 bent =
      p + 0.25 * dvec3(fractal_noise(0.5 * p, 2), fractal_noise(0.5 * p + 9.0, 2), 0.0);
  const double from_axis = std::hypot(bent.x + 0.2 * bent.z, bent.y);
  const double ring = from_axis * 3.0;
  const double in_ring = ring - std::floor(ring);
  const double late_share =
      smooth_step(0.2, 0.85, in_ring) * (1.0 - smooth_step(0.9, 1.0, in_ring));
  const double grain = 0.08 * gradient_noise(dvec3(20.0, 20.0, 1.5) * p);
  return glm::clamp(glm::mix(early, late, late_share) * (1.0 + grain), 0.0, 1.0);
}

dvec3 clouds(const dvec3& p) {
  const double cover = smooth_step(-0.15, 0.55, fractal_noise(0.8 * p, 6));
  return glm::mix(dvec3(0.36, 0.58, 0.9), dvec3(1.0), cover);
}

}  // namespace

double gradient_noise(const glm::dvec3& point) {
  const glm::dvec3 floor = glm::floor(point);
  const Lattice cell(floor);
  const glm::dvec3 inside = point - floor;
  const std::array<glm::dvec3, 2> offset{inside, inside - 1.0};  // from the lower and upper corners
  const glm::dvec3 part(faded(inside.x), faded(inside.y), faded(inside.z));
  const std::array<glm::dvec3, 2> weight{1.0 - part, part};
  const std::uint64_t x = static_cast<std::uint64_t>(cell.x) * kHashX;
  const std::uint64_t y = static_cast<std::uint64_t>(cell.y) * kHashY;
  const std::uint64_t z = static_cast<std::uint64_t>(cell.z) * kHashZ;
  double sum = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned i = corner % 2, j = corner / 2 % 2, k = corner / 4;
    const std::uint64_t hash = mixed(x + i * kHashX + y + j * kHashY + z + k * kHashZ);
    const glm::dvec3& to = kGradients[hash % kGradients.size()];
    sum += weight[i].x * weight[j].y * weight[k].z *
           (to.x * offset[i].x + to.y * offset[j].y + to.z * offset[k].z);
  }
  return sum;
}

double fractal_noise(const glm::dvec3& point, int octaves) {
  return over_octaves(point, octaves, [](double noise) { return noise; });
}

double turbulence(const glm::dvec3& point, int octaves) {
  return over_octaves(point, octaves, [](double noise) { return std::abs(noise); });
}

bool is_texture(scenes::Finish finish) {
  using enum scenes::Finish;
  return finish != kPlain && finish != kReflect && finish != kGlass && finish != kShiny;
}

TextureSpace::TextureSpace(const scenes::Scene& scene) {
  if (scene.primitives.empty()) return;
  const dvec3 low(scene.bounds.lower);
  const dvec3 high(scene.bounds.upper);
  const dvec3 size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  middle_ = 0.5 * (low + high);
  if (longest > 0.0) scale_ = kFeatures / longest;
}

dvec3 TextureSpace::color_at(const scenes::Surface& surface, const dvec3& point) const {
  const dvec3 p = (point - middle_) * scale_;
  const dvec3 own(surface.color);
  switch (surface.finish) {
    case scenes::Finish::kGranite:
      return granite(p, own);
    case scenes::Finish::kBlackMarble:
      return marble(p, own, dvec3(0.75, 0.73, 0.7));
    case scenes::Finish::kBlueMarble:
      return marble(p, own, dvec3(0.88, 0.9, 0.95));
    case scenes::Finish::kRedMarble:
      return marble(p, own, dvec3(0.92, 0.82, 0.78));
    case scenes::Finish::kWhiteMarble:
      return marble(p, own, dvec3(0.38, 0.4, 0.44));
    case scenes::Finish::kCherryWood:
      return wood(p, own * 1.15, own * 0.6);
    case scenes::Finish::kDarkWood:
      return wood(p, own * 1.2, own * 0.5);
    case scenes::Finish::kPineWood:
      return wood(p, own * 1.05, own * dvec3(0.75, 0.62, 0.5));
    case scenes::Finish::kClouds:
      return clouds(p);
    case scenes::Finish::kPlain:
    case scenes::Finish::kReflect:
    case scenes::Finish::kGlass:
    case scenes::Finish::kShiny:
      break;
  }
  return own;
}

}  // namespace beambench::render
