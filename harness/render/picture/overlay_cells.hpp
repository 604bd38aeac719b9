#pragma once
// The cells of a structure over a picture, in perspective.

#include <span>
#include <vector>

#include "accel/core/overlap.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/render/picture/category_legend.hpp"
#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Dims the picture that `rays` show and draws the cells over it as boxes that hide each other, of
/// glass to what is in them: the edges of faces turned to the eye, as far as no other cell is
/// before them, the paler the farther. A cell around the eye shows all its edges and hides none.
/// Returns what the color stands for.
std::vector<LegendEntry> overlay_cells(Image& image, const accel::PrimaryRays& rays,
                                       std::span<const accel::Box> cells);

}  // namespace beambench::render
