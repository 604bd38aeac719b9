#pragma once
// What Assimp may open while it reads a mesh.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/IOSystem.hpp>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Serves the mesh file from memory and its companions from the disk, read-only, and notes which
/// companions were asked for. Outlives what Assimp reads with it.
class AssimpFiles : public Assimp::IOSystem {
 public:
  /// The mesh is known as `name` and has these bytes, which must outlive this object.
  AssimpFiles(std::string name, std::string_view bytes);

  bool Exists(const char* name) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  /// The companions, relative to the mesh's folder.
  std::vector<MeshCompanion> companions() const;

 private:
  std::string name_;
  std::string_view bytes_;
  std::map<std::string, std::string> companions_;  // their bytes, by the name Assimp used
};

}  // namespace beambench::scenes::mesh
