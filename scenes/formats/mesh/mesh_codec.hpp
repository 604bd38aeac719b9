#pragma once
// Imported meshes as bytes, for the cache and for what one process tells another.

#include <string>
#include <string_view>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// The same bytes only on machines of one kind: numbers are as they lie in memory.
std::string encode(const ImportedMesh& imported);

/// Throws std::out_of_range when the bytes end too early. Bytes that `encode` did not make may give
/// any mesh; a scene builder refuses a wrong one.
ImportedMesh decode(std::string_view bytes);

}  // namespace beambench::scenes::mesh
