#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "scenes/catalogue.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/modelling/sweep.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// The plumage or skin at a point of the bird.
enum class Plumage : std::uint8_t { kPink, kWing, kFlightFeathers, kLeg, kBill, kBillTip };

/// A joint of a chain of limbs, with the chain's radius at the joint.
struct Joint {
  glm::dvec3 place;
  double radius;
};

double chain(const glm::dvec3& place, std::span<const Joint> joints) {
  double d = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < joints.size(); ++i) {
    const Joint& from = joints[i];
    const Joint& to = joints[i + 1];
    d = std::min(d, modelling::limb_field(place, {from.place, from.radius, to.place, to.radius}));
  }
  return d;
}

/// Returns the joints of a chain along a spline through the given joints.
std::vector<Joint> rounded(std::span<const Joint> joints) {
  constexpr int kSteps = 4;
  std::vector<glm::dvec3> knots;
  for (const Joint& joint : joints) knots.push_back(joint.place);
  const std::vector<glm::dvec3> places = modelling::spline(knots, kSteps);
  std::vector<Joint> result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t before = std::min(i / kSteps, joints.size() - 2);
    const double share = static_cast<double>(i - kSteps * before) / kSteps;
    result.push_back(
        {places[i], std::lerp(joints[before].radius, joints[before + 1].radius, share)});
  }
  return result;
}

double trunk(const glm::dvec3& p) {
  double d = modelling::limb_field(p, {{-0.20, 0.0, 0.88}, 0.130, {0.12, 0.0, 0.92}, 0.185});
  d = modelling::joined(
      d, modelling::limb_field(p, {{-0.20, 0.0, 0.86}, 0.10, {-0.47, 0.0, 0.76}, 0.028}), 0.10);
  return modelling::joined(
      d, modelling::limb_field(p, {{0.00, 0.0, 0.85}, 0.13, {0.02, 0.0, 0.74}, 0.09}), 0.10);
}

double neck_and_head(const glm::dvec3& p) {
  constexpr std::array<Joint, 10> kNeck = {{{{0.20, 0.0, 0.97}, 0.110},
                                            {{0.33, 0.0, 1.02}, 0.070},
                                            {{0.41, 0.0, 1.09}, 0.055},
                                            {{0.44, 0.0, 1.18}, 0.048},
                                            {{0.41, 0.0, 1.28}, 0.044},
                                            {{0.33, 0.0, 1.38}, 0.041},
                                            {{0.26, 0.0, 1.48}, 0.039},
                                            {{0.24, 0.0, 1.59}, 0.037},
                                            {{0.28, 0.0, 1.68}, 0.038},
                                            {{0.36, 0.0, 1.715}, 0.042}}};
  static const std::vector<Joint> neck = rounded(kNeck);
  const double d = chain(p, neck);
  return modelling::joined(
      d, modelling::ellipsoid_field(p, {0.39, 0.0, 1.705}, {0.085, 0.056, 0.060}), 0.03);
}

/// Returns the field of the bill, bent down in the middle.
double bill(const glm::dvec3& p) {
  const std::array<Joint, 4> joints = {{{{0.44, 0.0, 1.70}, 0.042},
                                        {{0.53, 0.0, 1.675}, 0.034},
                                        {{0.565, 0.0, 1.62}, 0.030},
                                        {{0.555, 0.0, 1.555}, 0.014}}};
  return chain({p.x, 1.2 * p.y, p.z}, joints);
}

double wings(const glm::dvec3& place) {
  // The wing is turned to slope toward the tail; its rows of feathers overlap like tiles.
  const glm::dvec3 p(place.x + 0.07, std::abs(place.y), place.z - 0.90);
  const double along = p.x * 0.97 + p.z * 0.24;
  const double across = p.z * 0.97 - p.x * 0.24;
  const double row = -along / 0.075 + 0.5 * std::abs(across / 0.10);
  const double step = 0.010 * (row - std::floor(row));
  return modelling::ellipsoid_field({along, p.y, across}, {-0.06, 0.135, 0.0},
                                    {0.34, 0.065, 0.145}) -
         step;
}

/// Returns the field of three toes in front of an ankle and a short one behind it.
double toes(const glm::dvec3& p, const glm::dvec3& ankle, const glm::dvec3& forward) {
  const glm::dvec3 aside(-forward.y, forward.x, 0.0);
  double d = 1e9;
  for (const double side : {-0.5, 0.0, 0.5}) {
    const glm::dvec3 tip = ankle + 0.13 * forward + 0.13 * side * aside;
    d = modelling::joined(d, modelling::limb_field(p, {ankle, 0.017, tip, 0.0135}), 0.02);
  }
  return modelling::joined(
      d, modelling::limb_field(p, {ankle, 0.017, ankle - 0.05 * forward, 0.0135}), 0.02);
}

double legs(const glm::dvec3& p) {
  const glm::dvec3 foot(0.02, 0.035, 0.016);
  const std::array<Joint, 4> standing = {{{{0.03, 0.06, 0.72}, 0.045},
                                          {{0.01, 0.05, 0.60}, 0.022},
                                          {{0.00, 0.045, 0.36}, 0.018},
                                          {foot, 0.017}}};
  double d = chain(p, standing);
  d = modelling::joined(d, modelling::ellipsoid_field(p, {0.0, 0.045, 0.36}, {0.028, 0.026, 0.040}),
                        0.02);
  d = modelling::joined(d, toes(p, foot, {1.0, 0.0, 0.0}), 0.02);
  // The other leg is drawn up: its heel points back, its foot is under the breast.
  const glm::dvec3 hanging(0.21, -0.06, 0.52);
  const std::array<Joint, 4> folded = {{{{0.02, -0.06, 0.72}, 0.045},
                                        {{-0.03, -0.06, 0.62}, 0.022},
                                        {{-0.13, -0.06, 0.43}, 0.019},
                                        {hanging, 0.017}}};
  d = modelling::joined(d, chain(p, folded), 0.005);
  const double heel = modelling::ellipsoid_field(p, {-0.13, -0.06, 0.43}, {0.030, 0.026, 0.036});
  d = modelling::joined(d, heel, 0.02);
  const glm::dvec3 toe(0.255, -0.06, 0.40);
  d = modelling::joined(d, modelling::limb_field(p, {hanging, 0.017, toe, 0.0145}), 0.02);
  d = modelling::joined(
      d, modelling::limb_field(p, {hanging, 0.017, toe + glm::dvec3(-0.02, 0.045, 0.0), 0.0135}),
      0.02);
  return modelling::joined(
      d, modelling::limb_field(p, {hanging, 0.017, toe + glm::dvec3(-0.02, -0.045, 0.0), 0.0135}),
      0.02);
}

/// Returns the field of a flamingo, 1.75 high, that stands at the origin on its left leg and faces
/// +x.
double flamingo_field(const glm::dvec3& p) {
  double d = modelling::joined(trunk(p), neck_and_head(p), 0.08);
  d = modelling::joined(d, wings(p), 0.012);
  d = modelling::joined(d, bill(p), 0.02);
  return modelling::joined(d, legs(p), 0.03);
}

Plumage flamingo_plumage(const glm::dvec3& p) {
  const double body = std::min(trunk(p), neck_and_head(p));
  const double wing = wings(p);
  if (bill(p) < std::min(body, 0.02)) {
    return p.x - 0.45 + 0.75 * (1.70 - p.z) > 0.13 ? Plumage::kBillTip : Plumage::kBill;
  }
  if (legs(p) < std::min(body, wing)) return p.z < 0.69 ? Plumage::kLeg : Plumage::kPink;
  if (wing < body && p.x < 0.12 - 7.0 * (p.z - 0.93) * (p.z - 0.93))
    return p.x < -0.29 - 0.9 * (p.z - 0.84) ? Plumage::kFlightFeathers : Plumage::kWing;
  return Plumage::kPink;
}

constexpr std::size_t kPolygons = 12874;
constexpr double kCell = 0.0193;

Surface surface_of(Plumage plumage) {
  switch (plumage) {
    case Plumage::kWing:
      return {.color = {0.94F, 0.36F, 0.42F}, .diffuse = 0.9F};
    case Plumage::kFlightFeathers:
      return {.color = {0.16F, 0.12F, 0.14F}, .diffuse = 0.9F};
    case Plumage::kLeg:
      return {.color = {0.90F, 0.50F, 0.48F}, .diffuse = 0.9F};
    case Plumage::kBill:
      return {.color = {0.97F, 0.84F, 0.78F}, .diffuse = 0.8F, .specular = 0.3F, .shine = 30.0F};
    case Plumage::kBillTip:
      return {.color = {0.10F, 0.09F, 0.10F}, .diffuse = 0.8F, .specular = 0.4F, .shine = 30.0F};
    default:
      return {.color = {1.0F, 0.64F, 0.66F}, .diffuse = 0.9F};
  }
}

void add_eyes(SceneBuilder& builder) {
  builder.set_surface(
      {.color = glm::vec3(0.05F), .diffuse = 0.8F, .specular = 0.6F, .shine = 50.0F});
  for (const double side : {-1.0, 1.0}) {
    modelling::PolygonMesh eye = modelling::ellipsoid(glm::dvec3(0.016), 12, 8);
    for (glm::dvec3& vertex : eye.vertices) vertex += glm::dvec3(0.425, 0.046 * side, 1.718);
    modelling::add_smooth(builder, modelling::outside(eye, flamingo_field));
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {1.6F, -3.7F, 1.25F},
                      .at = {0.03F, 0.0F, 0.87F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 29.5F});
  builder.set_background({0.62, 0.86, 0.88});
  builder.add_light({3.0, -4.0, 5.0}, glm::dvec3(0.8));
  builder.add_light({-4.0, -3.0, 1.0}, glm::dvec3(0.4));

  add_eyes(builder);
  const modelling::Region region = [](const glm::dvec3& place) {
    return static_cast<int>(flamingo_plumage(place));
  };
  const modelling::PolygonMesh rough =
      modelling::implicit_surface(flamingo_field, {-0.62, -0.30, -0.03}, {0.65, 0.30, 1.80}, kCell);
  const modelling::PolygonMesh bird = modelling::subdivided_to(
      modelling::drawn_to_borders(modelling::triangulated(rough), flamingo_field, region),
      kPolygons - builder.primitive_count());
  modelling::add_smooth(builder, bird,
                        {.crease = 60.0, .paint = [&](std::size_t polygon) {
                           return surface_of(flamingo_plumage(modelling::middle(bird, polygon)));
                         }});
  return std::move(builder).build();
}

}  // namespace

void register_flamenco(Catalogue& catalogue) {
  catalogue.add({"flamenco",
                 "The thesis's Flamenco: a flamingo of 12,874 polygons on one leg in empty space",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators
