#pragma once
// Surfaces from the material libraries of an OBJ file.

#include <map>
#include <string>
#include <vector>

#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// Returns surfaces by the names of their materials, and by what precedes a comment in a name.
/// Reads the libraries that `mtllib` lines name, each one file or several. A library that cannot be
/// read, or is not in the mesh's folder, is a warning, and so are lines of `newmtl`, `Kd`, `d` and
/// `Tr` that are not understood; all others have no part in a surface. Colors are the diffuse ones.
/// Textures are not read: a black material with one is a mean gray.
std::map<std::string, Surface> obj_surfaces(const std::vector<std::string>& libraries,
                                            MeshCompanions& companions,
                                            std::vector<std::string>& warnings);

}  // namespace beambench::scenes::mesh
