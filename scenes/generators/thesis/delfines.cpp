#include <array>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/dolphin.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/rotation.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kLength = 0.495;

struct Swimmer {
  glm::dvec3 place;
  double heading, climb, roll;  ///< degrees: about z, then the head up, then about its own length
  DolphinPose pose;
};

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {0.0F, -1.673F, 0.068F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 19.0F;
  camera.aspect = 1.25F;
  camera.width = 640;
  camera.height = 512;
  builder.add_camera(camera);
  builder.set_background({0.07, 0.30, 0.52});
  builder.add_light({-2.0, -3.0, 5.0});
  builder.add_light({2.0, -3.0, 1.0}, glm::dvec3(0.4));

  // Places and camera are fitted to the thesis's octree counts
  // (tests/accel/octree_counts_test.cpp): one behind the other, the line of the three makes the
  // root cube, the camera looks along it.
  constexpr std::array<Swimmer, 3> kSwimmers = {
      {{{-0.013, -0.356, -0.125}, 186.0, 6.0, 3.0, {0.5, 0.15}},
       {{0.166, 0.012, 0.026}, 28.0, -8.0, 16.0, {0.7, -0.1}},
       {{-0.174, 0.323, 0.190}, -35.0, 22.0, -1.0, {0.6, 0.2}}}};
  constexpr Surface kBack{
      .color = {0.34F, 0.45F, 0.56F}, .diffuse = 0.75F, .specular = 0.35F, .shine = 25.0F};
  constexpr Surface kBelly{
      .color = {0.86F, 0.90F, 0.92F}, .diffuse = 0.75F, .specular = 0.25F, .shine = 25.0F};
  for (const Swimmer& swimmer : kSwimmers) {
    glm::dmat4 place = glm::translate(glm::dmat4(1.0), swimmer.place);
    place *= modelling::rotation(2, swimmer.heading);
    place *= modelling::rotation(1, -swimmer.climb);
    place *= modelling::rotation(0, swimmer.roll);
    place = glm::scale(place, glm::dvec3(kLength));
    const Dolphin body = dolphin(swimmer.pose, 564);
    const modelling::PolygonMesh mesh = modelling::transformed(body.mesh, place);
    modelling::add_smooth(builder, mesh,
                          {.paint = [&](std::size_t i) { return body.belly[i] ? kBelly : kBack; }});
  }
  return std::move(builder).build();
}

}  // namespace

void register_delfines(Catalogue& catalogue) {
  catalogue.add({"delfines",
                 "The thesis's Delfines: three dolphins in three clearly separate places",
                 {},
                 generate});
}

}  // namespace beambench::scenes::generators
