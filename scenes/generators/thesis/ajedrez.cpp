#include <array>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/thesis/chess_pieces.hpp"
#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/rotation.hpp"
#include "scenes/modelling/square_ring.hpp"
#include "scenes/modelling/subdivide.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr std::size_t kPolygons = 19734;

/// The Spanish opening, 1. e4 e5 2. Nf3 Nc6 3. Bb5, seen from White's side: the eighth rank first,
/// White in capitals.
constexpr std::array<std::string_view, 8> kPosition = {{"r.bqkbnr", "pppp.ppp", "..n.....",
                                                        ".B..p...", "....P...", ".....N..",
                                                        "PPPP.PPP", "RNBQK..R"}};

/// The set's pieces, each modelled once.
class ChessSet {
 public:
  const modelling::PolygonMesh& piece(char name) const {
    switch (name) {
      case 'r':
        return rook_;
      case 'n':
        return knight_;
      case 'b':
        return bishop_;
      case 'q':
        return queen_;
      case 'k':
        return king_;
      default:
        return pawn_;
    }
  }

 private:
  modelling::PolygonMesh pawn_ = chess_pawn();
  modelling::PolygonMesh rook_ = chess_rook();
  modelling::PolygonMesh knight_ = chess_knight();
  modelling::PolygonMesh bishop_ = chess_bishop();
  modelling::PolygonMesh queen_ = chess_queen();
  modelling::PolygonMesh king_ = chess_king();
};

glm::dvec3 middle_of(std::size_t row, std::size_t column) {
  return {static_cast<double>(column) - 3.5, 3.5 - static_cast<double>(row), 0.0};
}

void add_squares(SceneBuilder& builder) {
  const Surface light = {.color = {0.93F, 0.83F, 0.64F}, .diffuse = 0.9F};
  const Surface dark = {.color = {0.45F, 0.25F, 0.13F}, .diffuse = 0.9F};
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      builder.set_surface((row + column) % 2 == 0 ? light : dark);
      const glm::dvec3 middle = middle_of(row, column);
      const std::array<glm::dvec3, 4> square = {
          {middle + glm::dvec3(-0.5, -0.5, 0.0), middle + glm::dvec3(0.5, -0.5, 0.0),
           middle + glm::dvec3(0.5, 0.5, 0.0), middle + glm::dvec3(-0.5, 0.5, 0.0)}};
      builder.add_polygon(square);
    }
  }
}

void add_pieces(SceneBuilder& builder) {
  const Surface white = {
      .color = {0.96F, 0.90F, 0.76F}, .diffuse = 0.85F, .specular = 0.35F, .shine = 40.0F};
  const Surface black = {
      .color = {0.20F, 0.13F, 0.11F}, .diffuse = 0.85F, .specular = 0.45F, .shine = 40.0F};
  const ChessSet set;
  for (std::size_t row = 0; row < 8; ++row) {
    for (std::size_t column = 0; column < 8; ++column) {
      const char name = kPosition[row][column];
      if (name == '.') continue;
      const bool is_white = name < 'a';
      builder.set_surface(is_white ? white : black);
      const glm::dmat4 place = glm::translate(glm::dmat4(1.0), middle_of(row, column));
      const char kind = is_white ? static_cast<char>(name - 'A' + 'a') : name;
      modelling::add_smooth(
          builder,
          modelling::transformed(set.piece(kind),
                                 is_white ? place : place * modelling::rotation(2, 180.0)),
          {.crease = 40.0});
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {-6.2F, -10.8F, 8.6F},
                      .at = {0.1F, -0.4F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .angle = 43.0F});
  builder.set_background({0.36, 0.47, 0.52});
  builder.add_light({-8.0, -4.0, 14.0}, glm::dvec3(0.8));
  builder.add_light({10.0, -12.0, 9.0}, glm::dvec3(0.4));

  add_squares(builder);
  add_pieces(builder);
  builder.set_surface(
      {.color = {0.34F, 0.16F, 0.08F}, .diffuse = 0.85F, .specular = 0.3F, .shine = 30.0F});
  modelling::add_flat(builder,
                      modelling::subdivided_to(modelling::square_ring(4.7, 4.0, -0.35, 0.08),
                                               kPolygons - builder.primitive_count()));
  return std::move(builder).build();
}

}  // namespace

void register_ajedrez(Catalogue& catalogue) {
  catalogue.add(
      {"ajedrez",
       "The thesis's Ajedrez: a chess set of 19,734 polygons on its board, in the Spanish opening",
       {},
       generate});
}

}  // namespace beambench::scenes::generators
