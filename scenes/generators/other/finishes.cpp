#include <array>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::array<std::array<Finish, 4>, 3> kRows = {{
    // rows from front to back
    {Finish::kReflect, Finish::kGlass, Finish::kShiny, Finish::kClouds},
    {Finish::kCherryWood, Finish::kDarkWood, Finish::kPineWood, Finish::kGranite},
    {Finish::kRedMarble, Finish::kWhiteMarble, Finish::kBlueMarble, Finish::kBlackMarble},
}};

void add_tiles(SceneBuilder& builder) {
  const std::array<Surface, 2> surfaces = {{{.color = {0.78F, 0.74F, 0.66F}, .diffuse = 0.8F},
                                            {.color = {0.42F, 0.46F, 0.44F}, .diffuse = 0.8F}}};
  constexpr double kWidth = 1.5;
  for (int row = -3; row < 7; ++row) {
    for (int column = -6; column < 6; ++column) {
      const glm::dvec3 low(kWidth * column, kWidth * row, 0.0);
      const std::array<glm::dvec3, 4> corners = {{low, low + glm::dvec3(kWidth, 0.0, 0.0),
                                                  low + glm::dvec3(kWidth, kWidth, 0.0),
                                                  low + glm::dvec3(0.0, kWidth, 0.0)}};
      builder.set_surface(surfaces[(row + column) % 2 == 0 ? 0 : 1]);
      builder.add_polygon(corners);
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {0.0F, -12.0F, 9.5F};
  camera.at = {0.0F, 2.2F, 0.6F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 29.0F;
  camera.aspect = 1.6F;
  camera.width = 640;
  camera.height = 400;
  builder.add_camera(camera);
  builder.set_background({0.35, 0.5, 0.7});
  builder.add_light({9.0, -12.0, 16.0});
  builder.add_light({-13.0, -9.0, 11.0});
  add_tiles(builder);
  for (std::size_t row = 0; row < kRows.size(); ++row) {
    for (std::size_t column = 0; column < kRows[row].size(); ++column) {
      builder.set_surface(finished_surface(kRows[row][column]));
      builder.add_sphere(
          {-3.75 + 2.5 * static_cast<double>(column), -0.75 + 3.0 * static_cast<double>(row), 1.0},
          1.0);
    }
  }
  return std::move(builder).build();
}

}  // namespace

void register_finishes(Catalogue& catalogue) {
  catalogue.add(
      {"finishes",
       "A ball of each of the thesis's surfaces and textures: mirror, glass, shiny and clouds in "
       "front, three woods and granite in the middle, four marbles at the back",
       {},
       generate});
}

}  // namespace beambench::scenes::generators
