#include <array>
#include <cstddef>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/base/random.hpp"
#include "scenes/generators/thesis/room/room.hpp"
#include "scenes/modelling/box.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kBoard = 0.028;
constexpr int kShelves = 5;
constexpr double kPlinth = 0.09;
constexpr double kFirst = kPlinth + kBoard;  // the lowest shelf's upper side
constexpr double kRise = (kBookshelf.z - kBoard - kFirst) / kShelves;

const Surface kWalnut = {
    .color = {0.36F, 0.21F, 0.12F}, .diffuse = 0.85F, .specular = 0.3F, .shine = 30.0F};
const Surface kPaper = {.color = {0.93F, 0.89F, 0.78F}, .diffuse = 0.9F};

Surface cloth(const glm::vec3& color) {
  return {.color = color, .diffuse = 0.9F, .specular = 0.2F, .shine = 20.0F};
}

constexpr std::array<glm::vec3, 10> kCovers = {{{0.62F, 0.13F, 0.12F},
                                                {0.13F, 0.27F, 0.45F},
                                                {0.16F, 0.38F, 0.24F},
                                                {0.80F, 0.62F, 0.22F},
                                                {0.45F, 0.20F, 0.36F},
                                                {0.86F, 0.80F, 0.66F},
                                                {0.25F, 0.47F, 0.52F},
                                                {0.72F, 0.38F, 0.17F},
                                                {0.22F, 0.20F, 0.22F},
                                                {0.66F, 0.66F, 0.62F}}};

/// The place of a book; its spine faces -y.
struct Book {
  double x, width, height, depth;
  glm::vec3 color;
};

/// Returns books from one side to the other; some shelves have a gap at the end.
std::vector<Book> row_of_books(Random& random, double length) {
  std::vector<Book> books;
  double x = 0.0;
  while (true) {
    const double width = random.uniform(0.019, 0.047);
    if (x + width > length) return books;
    books.push_back({x, width, random.uniform(0.19, 0.305), random.uniform(0.16, 0.23),
                     kCovers[random.below(kCovers.size())]});
    x += width + 0.0012;
  }
}

/// Returns the outline of a spine, which bulges, from left to right as (x, y).
std::vector<glm::dvec2> spine(const Book& book) {
  constexpr int kPieces = 4;
  std::vector<glm::dvec2> line;
  for (int i = 0; i <= kPieces; ++i) {
    const double s = 2.0 * i / kPieces - 1.0;
    line.emplace_back(book.x + 0.5 * book.width * (s + 1.0),
                      -book.depth - 0.14 * book.width * (1.0 - s * s));
  }
  return line;
}

/// Returns whether a book protrudes in front of or above its neighbor; true without a neighbor.
bool stands_out(const Book& book, const Book* neighbor) {
  constexpr double kSeen = 0.012;
  return neighbor == nullptr || book.height > neighbor->height + kSeen ||
         book.depth > neighbor->depth + kSeen;
}

void add_standing_book(PlacedPiece& shelf, const Book& book, const Book* left, const Book* right) {
  const std::vector<glm::dvec2> line = spine(book);
  modelling::PolygonMesh back;
  modelling::PolygonMesh bands;
  modelling::PolygonMesh top;
  const std::array<double, 4> heights = {0.0, 0.74 * book.height, 0.83 * book.height, book.height};
  const auto columns = static_cast<std::uint32_t>(line.size());
  for (const double z : heights) {
    for (const glm::dvec2& point : line) back.vertices.emplace_back(point, z);
  }
  bands.vertices = back.vertices;
  for (std::uint32_t row = 0; row + 1 < heights.size(); ++row) {
    modelling::PolygonMesh& mesh = row == 1 ? bands : back;
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t at = row * columns + i;
      mesh.polygons.push_back({at, at + 1, at + columns + 1, at + columns});
    }
  }
  modelling::PolygonMesh::Corners outline;
  for (const glm::dvec2& point : line) {
    outline.push_back(static_cast<std::uint32_t>(top.vertices.size()));
    top.vertices.emplace_back(point, book.height);
  }
  top.vertices.emplace_back(book.x + book.width, 0.0, book.height);
  top.vertices.emplace_back(book.x, 0.0, book.height);
  outline.push_back(columns);
  outline.push_back(columns + 1);
  top.polygons = {outline};

  modelling::PolygonMesh sides =
      modelling::box({book.x, -book.depth, 0.0}, {book.x + book.width, 0.0, book.height});
  std::vector<modelling::PolygonMesh::Corners> seen;
  if (stands_out(book, left)) seen.push_back(sides.polygons[0]);
  if (stands_out(book, right)) seen.push_back(sides.polygons[1]);
  sides.polygons = seen;
  shelf.smooth(cloth(book.color), back);
  shelf.smooth(cloth(glm::mix(book.color, glm::vec3(0.9F, 0.78F, 0.45F), 0.65F)), bands);
  shelf.flat(cloth(book.color), sides);
  shelf.flat(kPaper, top);
}

void add_carcass(PlacedPiece& piece) {
  const auto& [width, depth, height] = std::array{kBookshelf.x, kBookshelf.y, kBookshelf.z};
  // Every box lacks its back, which is against the wall.
  const auto board = [&](const glm::dvec3& lower, const glm::dvec3& upper,
                         std::initializer_list<std::size_t> faces) {
    const modelling::PolygonMesh whole = modelling::box(lower, upper);
    modelling::PolygonMesh seen;
    seen.vertices = whole.vertices;
    for (const std::size_t face : faces) seen.polygons.push_back(whole.polygons[face]);
    piece.flat(kWalnut, seen);
  };
  board({0.0, -depth, 0.0}, {kBoard, 0.0, height}, {0, 1, 2, 5});
  board({width - kBoard, -depth, 0.0}, {width, 0.0, height}, {0, 1, 2, 5});
  board({kBoard, -depth, height - kBoard}, {width - kBoard, 0.0, height}, {2, 4, 5});
  board({kBoard, -depth + 0.02, 0.0}, {width - kBoard, 0.0, kPlinth}, {2});
  for (int i = 0; i < kShelves; ++i) {
    const double top = kFirst + kRise * i;
    board({kBoard, -depth + 0.01, top - kBoard}, {width - kBoard, 0.0, top},
          i == 0 ? std::initializer_list<std::size_t>{2, 5}
                 : std::initializer_list<std::size_t>{2, 4, 5});
    const double above = i + 1 < kShelves ? top + kRise - kBoard : height - kBoard;
    const modelling::PolygonMesh back =
        modelling::box({kBoard, -0.001, top}, {width - kBoard, 0.0, above});
    modelling::PolygonMesh seen;
    seen.vertices = back.vertices;
    seen.polygons = {back.polygons[2]};
    piece.flat(kWalnut, seen);
  }
}

}  // namespace

void add_bookshelf(SceneBuilder& builder, const glm::dmat4& place) {
  PlacedPiece piece(builder, place);
  add_carcass(piece);
  Random random(1995);
  constexpr std::array<double, kShelves> kFilled = {1.0, 0.82, 1.0, 0.70, 0.94};
  for (int i = 0; i < kShelves; ++i) {
    const double length =
        kFilled[static_cast<std::size_t>(i)] * (kBookshelf.x - 2.0 * kBoard) - 0.004;
    const std::vector<Book> books = row_of_books(random, length);
    PlacedPiece shelf(builder, place * standing_at({kBoard + 0.002, -0.015, kFirst + kRise * i}));
    for (std::size_t k = 0; k < books.size(); ++k) {
      const bool at_gap = k + 1 == books.size() && kFilled[static_cast<std::size_t>(i)] < 0.99;
      // The carcass hides an end just as a neighbor of the same size would.
      const Book* left = k == 0 ? &books[k] : &books[k - 1];
      const Book* right = k + 1 < books.size() ? &books[k + 1] : at_gap ? nullptr : &books[k];
      add_standing_book(shelf, books[k], left, right);
    }
  }
}

void add_lying_book(SceneBuilder& builder, const glm::dmat4& place, const glm::dvec3& size,
                    const glm::vec3& color) {
  constexpr double kCover = 0.003;
  PlacedPiece book(builder, place);
  const glm::dvec3 half(0.5 * size.x, 0.5 * size.y, size.z);
  modelling::PolygonMesh cover = modelling::box({-half.x, -half.y, size.z - kCover}, half);
  modelling::append(
      cover, modelling::box_without_bottom({-half.x, -half.y, 0.0}, {half.x, half.y, kCover}));
  modelling::PolygonMesh spine_side =
      modelling::box({-half.x, -half.y, kCover}, {half.x, half.y, size.z - kCover});
  spine_side.polygons = {spine_side.polygons[2]};
  modelling::append(cover, spine_side);
  book.flat(cloth(color), cover);
  modelling::PolygonMesh pages = modelling::box({-half.x + 0.004, -half.y, kCover},
                                                {half.x - 0.004, half.y - 0.005, size.z - kCover});
  pages.polygons = {pages.polygons[0], pages.polygons[1], pages.polygons[3]};
  book.flat(kPaper, pages);
}

}  // namespace beambench::scenes::generators
