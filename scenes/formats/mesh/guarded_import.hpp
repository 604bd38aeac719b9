#pragma once
// Reads meshes where a malformed file can do no harm.

#include <filesystem>
#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// As import_mesh, in a process of its own: Assimp ends the process, or never returns, for some
/// files that are malformed or cut off. Throws InputError then, too: the file may need 2 s of
/// processor time, and another second for each MiB.
ImportedMesh guarded_import(std::string_view bytes, const std::string& ending,
                            const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh
