#pragma once
// The furnished room of `habitacion`, piece by piece.

#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/modelling/walls.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// The room is [0, x] x [0, y] x [0, z].
inline constexpr glm::dvec3 kRoom = {5.2, 5.8, 2.75};

/// The window's opening in the wall y = kRoom.y, from (x, z) to (x, z).
inline constexpr modelling::Rectangle kWindow = {{1.15, 1.02}, {2.65, 2.27}};

/// Adds boards, walls, ceiling, skirting, cornice, window and door, all facing inward. Boards
/// completely hidden by one of `covered` (rectangles of the floor) are left out.
void add_room(SceneBuilder& builder, std::span<const modelling::Rectangle> covered);

/// Returns the transform of a piece that stands upright at a place, turned counter-clockwise as
/// seen from above.
glm::dmat4 standing_at(const glm::dvec3& place, double degrees = 0.0);

/// Adds the meshes of one piece, moved to its position.
class PlacedPiece {
 public:
  PlacedPiece(SceneBuilder& builder, const glm::dmat4& place) : builder_(builder), place_(place) {}

  void flat(const Surface& surface, const modelling::PolygonMesh& mesh);
  void smooth(const Surface& surface, const modelling::PolygonMesh& mesh, double crease = 50.0);

 private:
  SceneBuilder& builder_;
  glm::dmat4 place_;
};

/// Returns the mesh without the polygons below a height, which the piece below hides.
modelling::PolygonMesh above(modelling::PolygonMesh mesh, double z);

inline constexpr double kDiningTop = 0.75;  ///< height of the dining table's top
inline constexpr double kCoffeeTop = 0.43;

/// Adds a round table of radius 0.56 on a turned column with four feet.
void add_dining_table(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a long low table, 1.16 x 0.62, on turned legs, with a shelf below.
void add_coffee_table(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a chair with a bowed back and spindles; a person sitting on it faces -y.
void add_chair(SceneBuilder& builder, const glm::dmat4& place);

/// A seat with arms, a back and loose cushions, standing at the origin and facing -y: 0.92 deep
/// (y from -0.48 to 0.44), 0.9 high.
struct Settee {
  double width;
  int places;
};
double settee_field(const glm::dvec3& place, const Settee& settee);

/// Returns the settee's surface in triangles, without the parts that face the floor.
modelling::PolygonMesh settee(const Settee& settee, double cell);
/// Returns four turned feet.
modelling::PolygonMesh settee_feet(const Settee& settee);

/// Returns a cushion of this half width and height that lies flat around the origin, with pointed
/// corners.
modelling::PolygonMesh scatter_cushion(double half, double height, int steps);

/// Adds a woven rug over a rectangle of the floor, with a quad for each knot of its pattern and
/// fringes left and right.
void add_rug(SceneBuilder& builder, const modelling::Rectangle& place);

/// Adds two curtains on a rod in the plane y = `y`, gathered to the sides of the window from
/// `window.lower` to `window.upper` (x, z).
void add_curtains(SceneBuilder& builder, const modelling::Rectangle& window, double y);

inline constexpr glm::dvec3 kBookshelf = {1.24, 0.32, 2.12};  ///< width, depth, height

/// Adds five shelves of books between x = 0 and the bookshelf's width, with the back at y = 0
/// against a wall, facing -y.
void add_bookshelf(SceneBuilder& builder, const glm::dmat4& place);

/// Adds a closed book that lies at the origin with its spine toward -y. `size` is its extent along
/// the spine, its extent across, and its thickness.
void add_lying_book(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec3& size,
                    const glm::vec3& color);

/// Adds a round teapot, 0.17 high, with its spout toward +x.
void add_china_teapot(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a cup of tea on its saucer, with its handle toward +x.
void add_cup(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a bowl of radius 0.17 with apples, oranges and a banana.
void add_fruit_bowl(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a vase with daisies, about 0.5 high.
void add_vase_of_flowers(SceneBuilder& builder, const glm::dmat4& place);

/// Adds a framed picture, 0.62 x 0.62, of Sierpinski's triangle, the planar counterpart of
/// `stetra`. It hangs on the wall, the plane z = 0 of `place`, with its lower left outer corner at
/// the origin.
void add_triangle_picture(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a picture of a sailing boat under the sun, 0.8 x 0.6, hung in the same way.
void add_boat_picture(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a clock of radius 0.17 around the origin of `place`, at ten past ten.
void add_clock(SceneBuilder& builder, const glm::dmat4& place);
/// Adds a pot with arching leaves, about 1.1 high.
void add_potted_plant(SceneBuilder& builder, const glm::dvec3& place);

/// Adds a ceiling lamp: `rim` is the middle of its shade's lower edge.
void add_hanging_lamp(SceneBuilder& builder, const glm::dvec3& rim, double ceiling);

/// Adds a standing lamp with a pleated shade, 1.66 high.
void add_floor_lamp(SceneBuilder& builder, const glm::dvec3& place);

}  // namespace beambench::scenes::generators
