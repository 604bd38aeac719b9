#pragma once
// Extruded capital letters.

#include <string_view>

#include "scenes/modelling/extrusion.hpp"

namespace beambench::scenes::modelling {

/// The outline of a capital letter, 1 high from the baseline y = 0, with its left edge at x = 0 and
/// its right edge at x = `width`. Strokes are straight, 0.22 wide, with cut corners; letters with
/// holes consist of concave polygons around them. The letters are A, B, E, G, I, L, O and T;
/// `letter` throws std::invalid_argument for any other.
struct Letter {
  FlatShape shape;
  double width;
};
Letter letter(char name);

/// Returns a line of letters and blanks, `height` high from y = 0, starting at x = 0, and extruded
/// from z = 0 to z = depth.
PolygonMesh extruded_text(std::string_view text, double height, double depth,
                          Ends ends = Ends::kBoth);
/// Returns the width of the line that `extruded_text` returns.
double text_width(std::string_view text, double height);

}  // namespace beambench::scenes::modelling
