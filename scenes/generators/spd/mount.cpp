#include <array>
#include <cmath>
#include <vector>

#include <glm/vec2.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kFractalDimension = 2.2;
constexpr double kHalfSize = 1.0;
constexpr std::int64_t kMountain = 21;  // each number gives a different mountain

/// Returns a normal deviate that depends only on the seed: the polar method over a linear
/// congruential generator modulo 134456 (Numerical Recipes).
double normal_deviate(std::int64_t seed) {
  constexpr std::int64_t kModulus = 134456;
  const auto next = [](std::int64_t state) { return (28411 + state * 8121) % kModulus; };
  const auto in_square = [](std::int64_t state) {
    return 2.0 * static_cast<double>(state) / kModulus - 1.0;
  };
  std::int64_t state = seed;
  while (true) {
    const std::int64_t first = next(state);
    state = next(first);
    const double u = in_square(first);
    const double v = in_square(state);
    const double r = u * u + v * v;
    if (r < 1.0) return u * std::sqrt(-2.0 * portable_log(r) / r);
  }
}

/// Returns the SPD's hash of a grid point. Its repetition over the mountain is part of the scene.
std::int64_t hash(std::uint64_t x, std::uint64_t y, std::int64_t n) {
  const auto shifted = [n](std::uint64_t value, std::int64_t by) {
    return by < n ? 0 : value << static_cast<std::uint64_t>(by - n);
  };
  const std::uint64_t sum = shifted(x, 23) + shifted(y, 15) + shifted(x, 7);
  return static_cast<std::int64_t>(sum & 0xFFFFU);
}

/// Heights over a square grid by Carpenter's midpoint displacement (Fournier, Fussell and
/// Carpenter 1982).
class Mountain {
 public:
  explicit Mountain(std::int64_t n)
      : n_(n), cells_(std::size_t{1} << n), heights_((cells_ + 1) * (cells_ + 1)) {
    const double ratio = 2.0 * portable_exp(-portable_log(2.0) / (kFractalDimension - 1.0));
    roughness_ = std::sqrt(ratio * ratio - 1.0);
    for (std::size_t width = cells_; width > 1; width /= 2) displace(width);
  }

  void add_to(SceneBuilder& builder) const {
    const double spacing = 2.0 * kHalfSize / static_cast<double>(cells_);
    for (std::size_t y = 0; y <= cells_; ++y) {
      for (std::size_t x = 0; x <= cells_; ++x) {
        builder.add_vertex({-kHalfSize + spacing * static_cast<double>(x),
                            -kHalfSize + spacing * static_cast<double>(y), heights_[at(x, y)]});
      }
    }
    add_section(builder, 0, 0, cells_);
  }

 private:
  std::size_t at(std::size_t x, std::size_t y) const { return y * (cells_ + 1) + x; }

  /// Displaces the centers of all squares of that width and the middles of their sides.
  void displace(std::size_t width) {
    const std::size_t half = width / 2;
    const double rise =
        roughness_ * 2.0 * kHalfSize * static_cast<double>(half) / static_cast<double>(cells_);
    const auto deviate = [&](std::size_t x, std::size_t y) {
      return rise * normal_deviate(kMountain + hash(x, y, n_));
    };
    for (std::size_t y = 0; y <= cells_; y += width) {
      for (std::size_t x = half; x <= cells_; x += width) {
        heights_[at(x, y)] =
            0.5 * (heights_[at(x - half, y)] + heights_[at(x + half, y)]) + deviate(x, y);
        heights_[at(y, x)] =
            0.5 * (heights_[at(y, x - half)] + heights_[at(y, x + half)]) + deviate(y, x);
      }
    }
    constexpr double kDiagonal = 1.4142136;  // the SPD's sqrt 2
    for (std::size_t y = half; y <= cells_; y += width) {
      for (std::size_t x = half; x <= cells_; x += width) {
        heights_[at(x, y)] =
            0.25 * (heights_[at(x - half, y - half)] + heights_[at(x + half, y - half)] +
                    heights_[at(x + half, y + half)] + heights_[at(x - half, y + half)]) +
            kDiagonal * deviate(x, y);
      }
    }
  }

  /// Adds two triangles for each cell of a square, quarter by quarter.
  void add_section(SceneBuilder& builder, std::size_t x, std::size_t y, std::size_t width) const {
    if (width > 1) {
      const std::size_t half = width / 2;
      add_section(builder, x, y, half);
      add_section(builder, x + half, y, half);
      add_section(builder, x + half, y + half, half);
      return add_section(builder, x, y + half, half);
    }
    const auto vertex = [&](std::size_t i, std::size_t j) {
      return static_cast<std::uint32_t>(at(x + i, y + j));
    };
    builder.add_polygon(std::array{vertex(0, 0), vertex(1, 0), vertex(1, 1)});
    builder.add_polygon(std::array{vertex(1, 1), vertex(0, 1), vertex(0, 0)});
  }

  std::int64_t n_;
  std::size_t cells_;
  std::vector<double> heights_;
  double roughness_ = 0.0;
};

/// Adds four spheres that touch one another, at the corners of a tetrahedron with its tip up.
void add_glass_spheres(SceneBuilder& builder) {
  constexpr glm::dvec3 kCenter(-0.8, 0.8, 1.0);
  constexpr double kRadius = 0.17;
  const double tip = kRadius * std::sqrt(1.5);
  // The tip turned by arccos(-1/3) about (1, 1, 0), then by thirds of a turn about z.
  const double out = tip * std::sqrt(8.0) / 3.0;
  const double half = std::sqrt(0.5);
  const double cos15 = (std::sqrt(6.0) + std::sqrt(2.0)) / 4.0;
  const double sin15 = (std::sqrt(6.0) - std::sqrt(2.0)) / 4.0;
  const std::array<glm::dvec2, 3> directions = {{{half, -half}, {sin15, cos15}, {-cos15, -sin15}}};
  builder.add_sphere(kCenter + glm::dvec3(0.0, 0.0, tip), kRadius);
  for (const glm::dvec2& direction : directions) {
    builder.add_sphere(kCenter + glm::dvec3(out * direction, -tip / 3.0), kRadius);
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-1.6F, 1.6F, 1.7F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 0.01F});
  builder.set_background(kSpdSky);
  builder.add_light({-100.0, -100.0, 100.0});
  builder.set_surface({.color = {1.0F, 1.0F, 1.0F},
                       .diffuse = 0.1F,
                       .specular = 0.1F,
                       .shine = 101.148F,
                       .transmittance = 0.9F,
                       .refraction_index = 1.5F});
  add_glass_spheres(builder);
  builder.set_surface({.color = {0.5F, 0.45F, 0.35F}});
  Mountain(parameters.integer("n")).add_to(builder);
  return std::move(builder).build();
}

}  // namespace

void register_mount(Catalogue& catalogue) {
  catalogue.add({"mount",
                 "Fractal mountain of 2 * 4^n triangles and four glass spheres (Haines's SPD)",
                 {integer_parameter("n", 6, 1, 12, "each step halves the cells of the grid")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators
