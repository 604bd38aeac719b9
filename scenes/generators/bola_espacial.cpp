#include "scenes/generators/bola_espacial.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include <glm/geometric.hpp>

#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/sweep.hpp"

namespace beambench {
namespace {

constexpr std::size_t kStruts = 512;  // of three sides each: 1,536 polygons
constexpr double kHalfWidth = 0.105;
constexpr double kShortened = 0.10;  // at both ends, so that struts do not run into one another

struct Strut {
  glm::ivec3 from, to;  ///< nodes of the face-centred lattice: integers of even sum
  double distance;      ///< of its middle from the ball's centre
};

/// Fuller's octet truss (US patent 2,986,241, 1961) in a ball: the struts between neighbours of the
/// face-centred cubic lattice that lie nearest to the centre.
std::vector<Strut> truss() {
  constexpr glm::dvec3 kCenter(0.31, 0.47, 0.13);  // of no symmetry: no two struts tie
  constexpr std::array<glm::ivec3, 6> kSteps = {
      {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}};
  constexpr int kReach = 8;
  std::vector<Strut> struts;
  for (int x = -kReach; x <= kReach; ++x) {
    for (int y = -kReach; y <= kReach; ++y) {
      for (int z = -kReach; z <= kReach; ++z) {
        if ((x + y + z) % 2 != 0) continue;
        const glm::ivec3 node(x, y, z);
        for (const glm::ivec3& step : kSteps) {
          const glm::dvec3 middle = glm::dvec3(node) + 0.5 * glm::dvec3(step) - kCenter;
          struts.push_back({node, node + step, glm::length(middle)});
        }
      }
    }
  }
  std::sort(struts.begin(), struts.end(), [](const Strut& a, const Strut& b) {
    return std::tie(a.distance, a.from.x, a.from.y, a.from.z) <
           std::tie(b.distance, b.from.x, b.from.y, b.from.z);
  });
  struts.resize(kStruts);
  return struts;
}

PolygonMesh beam_of(const Strut& strut) {
  const glm::dvec3 from(strut.from);
  const glm::dvec3 to(strut.to);
  const std::array<glm::dvec3, 2> path = {glm::mix(from, to, kShortened),
                                          glm::mix(to, from, kShortened)};
  constexpr std::array<double, 2> kRadii = {kHalfWidth, kHalfWidth};
  return tube(path, kRadii, 3);
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {8.24F, 5.76F, 4.53F},
                      .at = {0.31F, 0.47F, 0.13F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 32.5F});
  builder.set_background({0.02, 0.02, 0.07});
  builder.add_light({30.0, 6.0, 20.0}, glm::dvec3(0.8));
  builder.add_light({5.0, 30.0, -10.0}, glm::dvec3(0.4));

  const std::vector<Strut> struts = truss();
  constexpr glm::vec3 kCore(1.0F, 0.45F, 0.12F);
  constexpr glm::vec3 kRim(0.62F, 0.78F, 0.95F);
  for (const Strut& strut : struts) {
    const auto outward = static_cast<float>(strut.distance / struts.back().distance);
    builder.set_surface({.color = glm::mix(kCore, kRim, outward * outward),
                         .diffuse = 0.8F,
                         .specular = 0.3F,
                         .shine = 20.0F});
    add_flat(builder, beam_of(strut));
  }
  return std::move(builder).build();
}

}  // namespace

SceneInfo bola_espacial_scene() {
  return {"bola-espacial",
          "The thesis's Bola espacial: a ball of 512 triangular struts, its volume filled evenly",
          {},
          generate};
}

}  // namespace beambench
