#pragma once
// Reads glTF files with tinygltf.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

#include "scenes/formats/mesh/mesh_companions.hpp"

namespace beambench::scenes::mesh {

/// Reads a .gltf or .glb file and its buffers, but no images. Throws InputError, without the file's
/// name, if the file is malformed, if it requires an unsupported extension that changes its
/// geometry (the message names it), or if a buffer cannot be read or is not in the file's folder.
tinygltf::Model read_gltf(std::string_view bytes, MeshCompanions& companions);

/// Throws InputError for a file that is readable but contradicts itself or the glTF specification.
[[noreturn]] void refuse_gltf(std::string_view why);

/// Returns the list element that an index in the file refers to; `what` and `user` are for the
/// message: "node", "scene 0". Throws InputError if there is no such element.
template <typename T>
const T& element_of(const std::vector<T>& list, int index, std::string_view what,
                    std::string_view user);

/// Throws InputError because `user` refers to an element that does not exist.
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
