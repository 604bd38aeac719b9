#pragma once
// Writes scenes in Haines's Neutral File Format (NFF).

#include <ostream>

#include "scenes/scene.hpp"

namespace beambench::scenes::nff {

/// Writes a scene that `parse_nff` reads back bit for bit: primitives in their order, surfaces,
/// lights, cameras and background. Numbers are as short as that allows. A camera's name and aspect,
/// which NFF cannot express, are written as comments that begin with `kOwnComment`. The scene's
/// name and the sharing of vertices between polygons are lost: each polygon gets its own vertices,
/// at the same positions. The stream's state indicates whether writing succeeded.
void write_nff(const Scene& scene, std::ostream& stream);

}  // namespace beambench::scenes::nff
