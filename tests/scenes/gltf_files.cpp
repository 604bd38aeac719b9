#include "tests/scenes/gltf_files.hpp"

#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/put.hpp"

namespace beambench::scenes {
namespace {

using tests::put;
using Json = nlohmann::json;

int push(Json& list, const Json& element) {
  list.push_back(element);
  return static_cast<int>(list.size()) - 1;
}

void pad(std::string& bytes, char by) {
  while (bytes.size() % 4 != 0) bytes += by;
}

std::string chunk(const char* kind, const std::string& content) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(content.size()));
  return bytes + std::string(kind, 4) + content;
}

}  // namespace

GltfFile::GltfFile() {
  json = Json{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  json["scenes"] = Json::array({{{"nodes", Json::array()}}});
}

int GltfFile::add_view(const std::string& bytes, std::size_t stride) {
  pad(buffer, '\0');
  Json view{{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
  if (stride > 0) view["byteStride"] = stride;
  buffer += bytes;
  return push(json["bufferViews"], view);
}

int GltfFile::add_accessor(int view, GltfType type, std::size_t count, const char* shape) {
  return push(json["accessors"], {{"bufferView", view},
                                  {"componentType", static_cast<int>(type)},
                                  {"count", count},
                                  {"type", shape}});
}

int GltfFile::add_positions(const std::vector<glm::vec3>& positions, std::size_t stride) {
  std::string bytes;
  for (const glm::vec3& position : positions) {
    const std::size_t start = bytes.size();
    put(bytes, position);
    if (stride > 0) bytes.resize(start + stride, 'x');
  }
  return add_accessor(add_view(bytes, stride), GltfType::kFloat, positions.size(), "VEC3");
}

int GltfFile::add_indices(const std::vector<std::uint32_t>& indices, GltfType type) {
  std::string bytes;
  for (const std::uint32_t index : indices) {
    if (type == GltfType::kUByte) put(bytes, static_cast<std::uint8_t>(index));
    if (type == GltfType::kUShort) put(bytes, static_cast<std::uint16_t>(index));
    if (type == GltfType::kUInt) put(bytes, index);
  }
  return add_accessor(add_view(bytes), type, indices.size(), "SCALAR");
}

int GltfFile::add_mesh(int positions, int indices, int mode) {
  Json primitive{{"attributes", {{"POSITION", positions}}}, {"mode", mode}};
  if (indices >= 0) primitive["indices"] = indices;
  return push(json["meshes"], {{"primitives", Json::array({primitive})}});
}

int GltfFile::add_node(const Json& node) {
  const int number = push(json["nodes"], node);
  json["scenes"][0]["nodes"].push_back(number);
  return number;
}

std::string glb(const GltfFile& file) {
  std::string content = file.buffer;
  pad(content, '\0');
  Json json = file.json;
  json["buffers"] = Json::array({{{"byteLength", content.size()}}});
  for (const Json& more : file.json.value("buffers", Json::array())) {
    json["buffers"].push_back(more);
  }
  std::string text = json.dump();
  pad(text, ' ');
  const std::string chunks = chunk("JSON", text) + chunk("BIN\0", content);
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(12 + chunks.size()));
  return bytes + chunks;
}

std::string gltf(const GltfFile& file, const std::string& uri) {
  Json json = file.json;
  const std::string place =
      uri.empty() ? "data:application/octet-stream;base64," + base64(file.buffer) : uri;
  json["buffers"] = Json::array({{{"byteLength", file.buffer.size()}, {"uri", place}}});
  return json.dump();
}

GltfFile gltf_triangle() {
  GltfFile file;
  const int positions =
      file.add_positions({{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}});
  file.add_node({{"mesh", file.add_mesh(positions, -1)}});
  return file;
}

}  // namespace beambench::scenes
