#pragma once
// glTF files as tinygltf reads them.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/formats/mesh/mesh_companions.hpp"

namespace beambench::scenes::mesh {

/// Reads a .gltf or .glb file and its buffers, but no images. Throws InputError, without the
/// file's name: malformed; requires an extension that changes its geometry and is not supported,
/// which is named; a buffer that cannot be read, or that is not in the file's folder.
tinygltf::Model read_gltf(std::string_view bytes, MeshCompanions& companions);

/// Throws InputError: the file, which was read, contradicts itself or glTF.
[[noreturn]] void refuse_gltf(std::string_view why);

/// The element of a list of the file that an index names; `what` and `user` are for the message:
/// "node", "scene 0". Throws InputError when there is none.
template <typename T>
const T& element_of(const std::vector<T>& list, int index, std::string_view what,
                    std::string_view user);

/// Throws InputError: `user` names an element that is not there.
[[noreturn]] void refuse_index(int index, std::size_t size, std::string_view what,
                               std::string_view user);

template <typename T>
const T& element_of(const std::vector<T>& list, int index, std::string_view what,
                    std::string_view user) {
  if (index < 0 || static_cast<std::size_t>(index) >= list.size()) {
    refuse_index(index, list.size(), what, user);
  }
  return list[static_cast<std::size_t>(index)];
}

}  // namespace beambench::scenes::mesh
