#pragma once
// Reads the files that a mesh file refers to: material libraries, glTF buffers.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Reads the companions of one mesh file, only from its folder and subfolders: a downloaded mesh
/// must not gain access to the user's other files. Records the requested files.
class MeshCompanions {
 public:
  /// Reads companions of the mesh at `mesh`. The bytes of the mesh and its companions count toward
  /// the limit `kLargestMeshFile`.
  MeshCompanions(const std::filesystem::path& mesh, std::uint64_t mesh_bytes);

  /// Returns the folder of the companions.
  const std::filesystem::path& folder() const { return folder_; }

  /// Returns whether a companion exists and may be read. `list` includes missing files, because the
  /// mesh may change when a missing file appears.
  bool has(const std::filesystem::path& name);

  /// Returns the bytes of a companion; `name` is relative to the folder. The bytes live as long as
  /// this object, or until `release`. Throws InputError with the name if it is absolute or leads
  /// out of the folder (by `..` or a link), or if the companion cannot be read, is empty, or
  /// exceeds the limit together with the others.
  std::string_view read(const std::filesystem::path& name);

  /// Frees the bytes that `read` returned; `list` still contains the file.
  void release(const std::filesystem::path& name);

  /// Returns the files requested from the folder.
  std::vector<MeshCompanion> list() const;

 private:
  struct Companion {
    std::string bytes;
    std::uint64_t hash = 0;
  };

  std::filesystem::path folder_;
  std::uint64_t bytes_left_;
  std::map<std::string, Companion> companions_;
};

}  // namespace beambench::scenes::mesh
