#pragma once
// The files that a mesh file names: material libraries, glTF buffers.

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Reads the companions of one mesh file, from its folder and the folders in it alone: a file from
/// elsewhere must not be able to read what else the user may read. Notes what was asked for.
class MeshCompanions {
 public:
  /// Of the mesh at `mesh`, whose bytes count towards the limit of `kLargestMeshFile`, as do those
  /// of its companions.
  MeshCompanions(const std::filesystem::path& mesh, std::uint64_t mesh_bytes);

  /// Where they lie.
  const std::filesystem::path& folder() const { return folder_; }

  /// Whether a companion is there and may be read. `list` has a missing one, too: the mesh may
  /// change when that file appears.
  bool has(const std::filesystem::path& name);

  /// The bytes of a companion, `name` being relative to the folder; they stay as long as this
  /// object. Throws InputError naming it when it is absolute or leads out of the folder (by `..`
  /// or a link), cannot be read, is empty, or is too much together with the others.
  std::string_view read(const std::filesystem::path& name);

  /// Frees the bytes that `read` returned, but remembers what was read.
  void release(const std::filesystem::path& name);

  /// What was asked for in the folder.
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
