#include "scenes/generators/thesis/teapot_patches.hpp"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace beambench::scenes::generators {
namespace {

/// Four control points of a quarter circle of that radius at that height. Newell's arcs have their
/// inner points at 0.56 of the radius, not at the 0.5523 that comes nearest to a circle; those of
/// the lid's knob at 0.5625.
struct Arc {
  double radius;
  double height;
  double inner = 0.56;
};
using LatheSection = std::array<Arc, 4>;

/// Turned around the z axis: rim; body, upper and lower half; knob and lid. Clockwise from above.
constexpr std::array<LatheSection, 3> kBody = {
    {{{{1.4, 2.4}, {1.3375, 2.53125}, {1.4375, 2.53125}, {1.5, 2.4}}},
     {{{1.5, 2.4}, {1.75, 1.875}, {2.0, 1.35}, {2.0, 0.9}}},
     {{{2.0, 0.9}, {2.0, 0.45}, {1.5, 0.225}, {1.5, 0.15}}}}};
constexpr std::array<LatheSection, 2> kLid = {
    {{{{0.0, 3.15}, {0.8, 3.15, 0.5625}, {0.0, 2.85}, {0.2, 2.7}}},
     {{{0.2, 2.7}, {0.4, 2.55}, {1.3, 2.55}, {1.3, 2.4}}}}};
/// Counter-clockwise: it is seen from below.
constexpr LatheSection kBottom = {{{0.0, 0.0}, {1.425, 0.0}, {1.5, 0.075}, {1.5, 0.15}}};

/// Four control points around one side of a tube: from a point of the plane y = 0, out to y =
/// -width and to another point of that plane.
struct Loop {
  glm::dvec2 from;  ///< x and z
  glm::dvec2 to;
  double width;
};
using TubeSection = std::array<Loop, 4>;

constexpr std::array<TubeSection, 2> kHandle = {{{{{{-1.6, 2.025}, {-1.5, 2.25}, 0.3},
                                                   {{-2.3, 2.025}, {-2.5, 2.25}, 0.3},
                                                   {{-2.7, 2.025}, {-3.0, 2.25}, 0.3},
                                                   {{-2.7, 1.8}, {-3.0, 1.8}, 0.3}}},
                                                 {{{{-2.7, 1.8}, {-3.0, 1.8}, 0.3},
                                                   {{-2.7, 1.575}, {-3.0, 1.35}, 0.3},
                                                   {{-2.5, 1.125}, {-2.65, 0.9375}, 0.3},
                                                   {{-2.0, 0.9}, {-1.9, 0.6}, 0.3}}}}};
constexpr std::array<TubeSection, 2> kSpout = {{{{{{1.7, 1.425}, {1.7, 0.6}, 0.66},
                                                  {{2.6, 1.425}, {3.1, 0.825}, 0.66},
                                                  {{2.3, 2.1}, {2.4, 2.025}, 0.25},
                                                  {{2.7, 2.4}, {3.3, 2.4}, 0.25}}},
                                                {{{{2.7, 2.4}, {3.3, 2.4}, 0.25},
                                                  {{2.8, 2.475}, {3.525, 2.49375}, 0.25},
                                                  {{2.9, 2.475}, {3.45, 2.5125}, 0.15},
                                                  {{2.8, 2.4}, {3.2, 2.4}, 0.15}}}}};

/// Quarter after quarter around z, the first from +x on; `sense` is -1 for clockwise.
void append_lathe(std::vector<BezierPatch>& patches, const LatheSection& section, double sense) {
  for (int quarter = 0; quarter < 4; ++quarter) {
    BezierPatch patch;
    for (std::size_t row = 0; row < 4; ++row) {
      const auto [radius, height, inner] = section[row];
      const std::array<glm::dvec2, 4> arc = {{{1.0, 0.0}, {1.0, inner}, {inner, 1.0}, {0.0, 1.0}}};
      for (std::size_t column = 0; column < 4; ++column) {
        glm::dvec2 place = radius * arc[column];
        for (int turn = 0; turn < quarter; ++turn) place = {-place.y, place.x};
        patch[row][column] = {place.x, sense * place.y, height};
      }
    }
    patches.push_back(patch);
  }
}

/// The two sides of a tube: -y from `from` to `to`, then +y back.
void append_tube(std::vector<BezierPatch>& patches, const TubeSection& section) {
  BezierPatch side;
  BezierPatch other;
  for (std::size_t row = 0; row < 4; ++row) {
    const auto& [from, to, width] = section[row];
    side[row] = {
        {{from.x, 0.0, from.y}, {from.x, -width, from.y}, {to.x, -width, to.y}, {to.x, 0.0, to.y}}};
    for (std::size_t column = 0; column < 4; ++column) {
      const glm::dvec3& mirrored = side[row][3 - column];
      other[row][column] = {mirrored.x, -mirrored.y, mirrored.z};
    }
  }
  patches.push_back(side);
  patches.push_back(other);
}

struct CubicBasis {
  std::array<double, 4> value;
  std::array<double, 4> derivative;
};

/// Bernstein's polynomials of degree 3.
CubicBasis cubic_basis(double t) {
  const double u = 1.0 - t;
  return {{u * u * u, 3.0 * t * u * u, 3.0 * t * t * u, t * t * t},
          {-3.0 * u * u, 3.0 * u * (u - 2.0 * t), 3.0 * t * (2.0 * u - t), 3.0 * t * t}};
}

}  // namespace

std::vector<BezierPatch> teapot_patches() {
  std::vector<BezierPatch> patches;
  for (const LatheSection& section : kBody) append_lathe(patches, section, -1.0);
  for (const TubeSection& section : kHandle) append_tube(patches, section);
  for (const TubeSection& section : kSpout) append_tube(patches, section);
  for (const LatheSection& section : kLid) append_lathe(patches, section, -1.0);
  append_lathe(patches, kBottom, 1.0);
  return patches;
}

PatchPoint evaluate_patch(const BezierPatch& patch, double s, double t) {
  const CubicBasis row = cubic_basis(s);
  const CubicBasis column = cubic_basis(t);
  glm::dvec3 position(0.0);
  glm::dvec3 along_s(0.0);
  glm::dvec3 along_t(0.0);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      position += row.value[i] * column.value[j] * patch[i][j];
      along_s += row.derivative[i] * column.value[j] * patch[i][j];
      along_t += row.value[i] * column.derivative[j] * patch[i][j];
    }
  }
  return {position, glm::cross(along_t, along_s)};
}

}  // namespace beambench::scenes::generators
