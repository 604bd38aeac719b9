#pragma once
// glTF files made for tests.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

namespace beambench::scenes {

/// glTF's codes for component types.
enum class GltfType { kByte = 5120, kUByte, kShort, kUShort, kUInt = 5125, kFloat };

/// A file under construction: its JSON, and one buffer. Begins with a default scene without nodes.
struct GltfFile {
  GltfFile();

  /// Each function returns the index of the object that it added.
  int add_view(const std::string& bytes, std::size_t stride = 0);
  int add_accessor(int view, GltfType type, std::size_t count, const char* shape);
  int add_positions(const std::vector<glm::vec3>& positions, std::size_t stride = 0);
  int add_indices(const std::vector<std::uint32_t>& indices, GltfType type);
  /// Adds a mesh of one primitive, without indices if `indices` is -1.
  int add_mesh(int positions, int indices, int mode = 4);
  /// Adds a node to the default scene.
  int add_node(const nlohmann::json& node);

  nlohmann::json json;
  std::string buffer;
};

/// Returns a .glb file.
std::string glb(const GltfFile& file);
/// Returns a .gltf file whose buffer is at a URI; by default, in the text.
std::string gltf(const GltfFile& file, const std::string& uri = "");

/// Returns one triangle, (0,0,0) (1,0,0) (0,1,0), in one node.
GltfFile gltf_triangle();

}  // namespace beambench::scenes
