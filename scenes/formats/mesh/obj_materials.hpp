#pragma once
// Surfaces from the material libraries of an OBJ file.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// Surfaces by the names of their materials. Reads the libraries that `mtllib` lines name, each
/// one file or several; one that cannot be read, or is not in the mesh's folder, is a warning.
/// Colors are the diffuse ones, textures are not read: a black material with one is a mean gray.
std::map<std::string, Surface> obj_surfaces(const std::vector<std::string>& libraries,
                                            MeshCompanions& companions,
                                            std::vector<std::string>& warnings);

/// A name of a material without blanks at its ends, as it is a key of `obj_surfaces`.
std::string_view material_name(std::string_view text);

}  // namespace beambench::scenes::mesh
