#pragma once
// Surfaces from the material libraries of an OBJ file.

#include <map>
#include <string>
#include <vector>

#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// Returns surfaces by the names of their materials, both with and without a trailing comment.
/// Reads the libraries that `mtllib` lines name; a line may name several. Libraries that cannot be
/// read or are not in the mesh's folder cause a warning, as do invalid `newmtl`, `Kd`, `d` and `Tr`
/// lines; other lines do not affect a surface. Colors are the diffuse colors. Textures are not
/// read: a black material with a texture becomes a mean gray.
std::map<std::string, Surface> obj_surfaces(const std::vector<std::string>& libraries,
                                            MeshCompanions& companions,
                                            std::vector<std::string>& warnings);

}  // namespace beambench::scenes::mesh
