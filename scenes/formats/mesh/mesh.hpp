#pragma once
// What a mesh file holds, as far as rays are concerned.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/scene.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// Triangles in a row that have one surface.
struct MeshPart {
  Surface surface;
  std::uint32_t triangle_count = 0;

  bool operator==(const MeshPart&) const = default;
};

/// Triangles over shared vertices.
struct TriangleMesh {
  std::vector<glm::vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into vertices
  std::vector<MeshPart> parts;                          ///< together they are all triangles
};

/// A file that a mesh file brought in (a material library, a glTF buffer): its path, relative to
/// the mesh's folder, and the hash of its bytes; 0 when there was no such file.
struct MeshCompanion {
  std::string path;
  std::uint64_t hash = 0;
};

/// A mesh that a scene can hold, with the cameras and lights of its file, and what was left out of
/// it (without the file's name).
struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<Camera> cameras;  ///< each accepted by a scene builder, no two of one name
  std::vector<Light> lights;
  std::vector<std::string> warnings;
  std::vector<MeshCompanion> companions;
};

// Imported meshes as bytes, for the cache and from one process to another.

/// Takes the next bytes of a mesh.
using ByteSink = std::function<void(const char* bytes, std::size_t count)>;
/// Fills a buffer with the next bytes of a mesh; throws std::out_of_range where they end too early.
using ByteSource = std::function<void(char* buffer, std::size_t count)>;

/// Part by part, so that a large mesh is not in memory twice. The same bytes only on machines of
/// one kind: numbers are as in memory.
void encode(const ImportedMesh& imported, const ByteSink& sink);
/// The same, as one text.
std::string encode(const ImportedMesh& imported);

/// Throws std::out_of_range when the bytes end too early, or a list claims more than `at_most`
/// bytes, and std::bad_alloc when memory does not suffice. Bytes that `encode` did not make may
/// give any mesh; a scene builder refuses an invalid one.
ImportedMesh decode(const ByteSource& source, std::uint64_t at_most);
/// The same, from one text.
ImportedMesh decode(std::string_view bytes);

}  // namespace beambench::scenes::mesh
