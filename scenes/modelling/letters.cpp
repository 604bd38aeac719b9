#include "scenes/modelling/letters.hpp"

#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace beambench::scenes::modelling {
namespace {

constexpr double kGap = 0.14;    // between two letters
constexpr double kBlank = 0.45;  // a blank's width

/// Returns a ring between an outer and an inner outline (counter-clockwise, with equal numbers of
/// points): two concave halves, with seams between the outlines at point 0 and at point `half`.
FlatShape ring(const std::vector<glm::dvec2>& outer, const std::vector<glm::dvec2>& inner,
               std::uint32_t half) {
  const auto n = static_cast<std::uint32_t>(outer.size());
  FlatShape shape;
  shape.points = outer;
  shape.points.insert(shape.points.end(), inner.begin(), inner.end());
  PolygonMesh::Corners first;
  PolygonMesh::Corners second;
  for (std::uint32_t i = 0; i <= half; ++i) first.push_back(i);
  for (std::uint32_t i = half + 1; i > 0; --i) first.push_back(n + i - 1);
  for (std::uint32_t i = half; i <= n; ++i) second.push_back(i % n);
  for (std::uint32_t i = n + 1; i > half; --i) second.push_back(n + (i - 1) % n);
  shape.polygons = {first, second};
  return shape;
}

/// Returns an A: the legs from the foot to the bar and, above the bar, a ring around the hole.
Letter letter_a() {
  FlatShape shape;
  shape.points = {{0.00, 0.00}, {0.23, 0.00}, {0.29, 0.22}, {0.51, 0.22},
                  {0.57, 0.00}, {0.80, 0.00}, {0.52, 1.00}, {0.28, 1.00},
                  {0.34, 0.40}, {0.46, 0.40}, {0.40, 0.66}};
  shape.polygons = {{0, 1, 2, 3, 4, 5, 6, 10, 9, 8}, {0, 8, 10, 6, 7}};
  return {shape, 0.80};
}

/// Returns a B: a ring around both holes and the bar between them, in one left and two right parts.
Letter letter_b() {
  FlatShape shape;
  shape.points = {{0.00, 0.00}, {0.50, 0.00}, {0.66, 0.14}, {0.66, 0.40}, {0.54, 0.51},
                  {0.64, 0.61}, {0.64, 0.86}, {0.50, 1.00}, {0.00, 1.00}, {0.22, 0.20},
                  {0.42, 0.20}, {0.42, 0.40}, {0.22, 0.40}, {0.22, 0.61}, {0.41, 0.61},
                  {0.41, 0.80}, {0.22, 0.80}};
  shape.polygons = {
      {0, 9, 12, 13, 16, 8}, {0, 1, 2, 3, 4, 11, 10, 9}, {11, 4, 5, 6, 7, 8, 16, 15, 14, 13, 12}};
  return {shape, 0.66};
}

Letter letter_o() {
  return {ring({{0.16, 0.00},
                {0.56, 0.00},
                {0.72, 0.18},
                {0.72, 0.82},
                {0.56, 1.00},
                {0.16, 1.00},
                {0.00, 0.82},
                {0.00, 0.18}},
               {{0.28, 0.22},
                {0.44, 0.22},
                {0.50, 0.30},
                {0.50, 0.70},
                {0.44, 0.78},
                {0.28, 0.78},
                {0.22, 0.70},
                {0.22, 0.30}},
               4),
          0.72};
}

}  // namespace

Letter letter(char name) {
  switch (name) {
    case 'A':
      return letter_a();
    case 'B':
      return letter_b();
    case 'E':
      return {flat_polygon({{0.00, 0.00},
                            {0.58, 0.00},
                            {0.58, 0.21},
                            {0.22, 0.21},
                            {0.22, 0.40},
                            {0.50, 0.40},
                            {0.50, 0.60},
                            {0.22, 0.60},
                            {0.22, 0.79},
                            {0.58, 0.79},
                            {0.58, 1.00},
                            {0.00, 1.00}}),
              0.58};
    case 'G':
      return {flat_polygon({{0.16, 0.00}, {0.56, 0.00}, {0.70, 0.16}, {0.70, 0.54}, {0.38, 0.54},
                            {0.38, 0.36}, {0.48, 0.36}, {0.48, 0.22}, {0.28, 0.22}, {0.22, 0.30},
                            {0.22, 0.70}, {0.28, 0.78}, {0.44, 0.78}, {0.50, 0.68}, {0.70, 0.68},
                            {0.70, 0.82}, {0.54, 1.00}, {0.16, 1.00}, {0.00, 0.82}, {0.00, 0.18}}),
              0.70};
    case 'I':
      return {flat_polygon({{0.00, 0.00}, {0.22, 0.00}, {0.22, 1.00}, {0.00, 1.00}}), 0.22};
    case 'L':
      return {
          flat_polygon(
              {{0.00, 0.00}, {0.56, 0.00}, {0.56, 0.22}, {0.22, 0.22}, {0.22, 1.00}, {0.00, 1.00}}),
          0.56};
    case 'O':
      return letter_o();
    case 'T':
      return {flat_polygon({{0.24, 0.00},
                            {0.46, 0.00},
                            {0.46, 0.79},
                            {0.70, 0.79},
                            {0.70, 1.00},
                            {0.00, 1.00},
                            {0.00, 0.79},
                            {0.24, 0.79}}),
              0.70};
    default:
      throw std::invalid_argument(fmt::format("there is no letter '{}'", name));
  }
}

PolygonMesh extruded_text(std::string_view text, double height, double depth, Ends ends) {
  PolygonMesh mesh;
  double x = 0.0;
  for (const char name : text) {
    if (name == ' ') {
      x += kBlank + kGap;
      continue;
    }
    const Letter next = letter(name);
    PolygonMesh body = extruded(next.shape, 1.0, ends);
    const glm::dmat4 place = glm::scale(glm::dmat4(1.0), glm::dvec3(height, height, depth));
    append(mesh, transformed(std::move(body), glm::translate(place, glm::dvec3(x, 0.0, 0.0))));
    x += next.width + kGap;
  }
  return mesh;
}

double text_width(std::string_view text, double height) {
  double width = text.empty() ? 0.0 : -kGap;
  for (const char name : text) width += (name == ' ' ? kBlank : letter(name).width) + kGap;
  return height * width;
}

}  // namespace beambench::scenes::modelling
