#pragma once
// The contents of a mesh file that affect rays.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/formats/mesh/mesh_motion.hpp"
#include "scenes/scene.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// Consecutive triangles that share a surface.
struct MeshPart {
  Surface surface;
  std::uint32_t triangle_count = 0;

  bool operator==(const MeshPart&) const = default;
};

/// Triangles over shared vertices.
struct TriangleMesh {
  std::vector<glm::vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices
  std::vector<MeshPart> parts;                          ///< together they cover all triangles
};

/// A file that a mesh file refers to (a material library, a glTF buffer): its path, relative to the
/// mesh's folder, and the hash of its bytes; 0 if there was no such file.
struct MeshCompanion {
  std::string path;
  std::uint64_t hash = 0;
};

/// A mesh that is valid in a scene, with the cameras and lights of its file, and warnings about
/// omitted parts (without the file's name).
struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<Camera> cameras;  ///< each accepted by a scene builder, with unique names
  std::vector<Light> lights;
  std::vector<std::string> warnings;
  std::vector<MeshCompanion> companions;
  MeshMotion motion{};
};

// Serialization of imported meshes, for the cache and for sending between processes.

/// Receives the next bytes of a mesh.
using ByteSink = std::function<void(const char* bytes, std::size_t count)>;
/// Fills a buffer with the next bytes of a mesh; throws std::out_of_range if they end too early.
using ByteSource = std::function<void(char* buffer, std::size_t count)>;

/// Encodes in parts, so that a large mesh is not in memory twice. Numbers have their in-memory
/// format, so machines with different formats produce different bytes.
void encode(const ImportedMesh& imported, const ByteSink& sink);
/// Encodes to a string.
std::string encode(const ImportedMesh& imported);

/// Decodes a mesh. Throws std::out_of_range if the bytes end early, a list claims more than
/// `at_most` bytes, or the motion does not match the mesh, and std::bad_alloc if memory runs out.
/// Bytes not made by `encode` may yield any mesh; a scene builder refuses invalid meshes.
ImportedMesh decode(const ByteSource& source, std::uint64_t at_most);
/// Decodes from a string.
ImportedMesh decode(std::string_view bytes);

}  // namespace beambench::scenes::mesh
