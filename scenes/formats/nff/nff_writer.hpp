#pragma once
// Writes scenes in Haines's Neutral File Format (NFF).

#include <ostream>

#include "scenes/scene.hpp"

namespace beambench::scenes::nff {

/// Writes a scene that `parse_nff` reads back bit for bit: primitives in their order, surfaces,
/// lights, cameras and background. Numbers are as short as that allows. What NFF has no words for
/// (a camera's name and aspect) stands in comments that begin with `kOwnComment`. Lost are the
/// scene's name, and which polygons share a vertex: each gets vertices of its own, at the same
/// places. The stream's state says whether writing succeeded.
void write_nff(const Scene& scene, std::ostream& stream);

}  // namespace beambench::scenes::nff
