#include "scenes/formats/mesh/mesh.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace beambench::scenes::mesh {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16U;  // list elements read at a time

/// Writes numbers, strings and lists to a sink.
class Writer {
 public:
  explicit Writer(const ByteSink& sink) : sink_(&sink) {}

  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    (*sink_)(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  void put_list(const std::vector<T>& list) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t{list.size()});
    if (!list.empty()) {
      (*sink_)(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
    }
  }
  void put_text(const std::string& text) {
    put(std::uint64_t{text.size()});
    (*sink_)(text.data(), text.size());
  }
  void put_camera(const Camera& camera) {
    put_text(camera.name);
    for (const glm::vec3& vector : {camera.from, camera.at, camera.up}) put(vector);
    for (const float number : {camera.angle, camera.aspect, camera.hither}) put(number);
    for (const int number : {camera.width, camera.height}) put(number);
  }

 private:
  const ByteSink* sink_;
};

/// Reads numbers, strings and lists from a source; throws std::out_of_range at its end.
class Reader {
 public:
  Reader(const ByteSource& source, std::uint64_t at_most) : source_(&source), left_(at_most) {}

  template <typename T>
  T take() {
    T value;
    take_bytes(reinterpret_cast<char*>(&value), 1, sizeof(T));
    return value;
  }
  template <typename T>
  std::vector<T> take_list() {
    const auto count = take<std::uint64_t>();
    require(count, sizeof(T));
    std::vector<T> list;
    list.reserve(count);
    while (list.size() < count) {  // in parts, so that memory is used only for existing data
      const std::size_t before = list.size();
      list.resize(before + std::min<std::size_t>(count - before, kBlock));
      take_bytes(reinterpret_cast<char*>(list.data() + before), list.size() - before, sizeof(T));
    }
    return list;
  }
  std::string take_text() {
    const auto count = take<std::uint64_t>();
    require(count, 1);
    std::string text(count, '\0');
    take_bytes(text.data(), count, 1);
    return text;
  }
  Camera take_camera() {
    Camera camera;
    camera.name = take_text();
    for (glm::vec3* vector : {&camera.from, &camera.at, &camera.up}) *vector = take<glm::vec3>();
    for (float* number : {&camera.angle, &camera.aspect, &camera.hither}) *number = take<float>();
    for (int* number : {&camera.width, &camera.height}) *number = take<int>();
    return camera;
  }

 private:
  void require(std::uint64_t count, std::size_t each) const {
    if (count > left_ / each) throw std::out_of_range("the mesh ends too early");
  }
  void take_bytes(char* into, std::uint64_t count, std::size_t each) {
    require(count, each);
    (*source_)(into, count * each);
    left_ -= count * each;
  }

  const ByteSource* source_;
  std::uint64_t left_;
};

}  // namespace

void encode(const ImportedMesh& imported, const ByteSink& sink) {
  Writer writer(sink);
  writer.put(std::uint64_t{imported.companions.size()});
  for (const MeshCompanion& companion : imported.companions) {
    writer.put_text(companion.path);
    writer.put(companion.hash);
  }
  writer.put(std::uint64_t{imported.warnings.size()});
  for (const std::string& warning : imported.warnings) writer.put_text(warning);
  writer.put(std::uint64_t{imported.cameras.size()});
  for (const Camera& camera : imported.cameras) writer.put_camera(camera);
  writer.put_list(imported.lights);
  writer.put_list(imported.mesh.vertices);
  writer.put_list(imported.mesh.triangles);
  writer.put_list(imported.mesh.parts);
  writer.put(imported.motion.frames);
  writer.put_list(imported.motion.vertices);
  writer.put_list(imported.motion.influences);
  writer.put_list(imported.motion.matrices);
}

std::string encode(const ImportedMesh& imported) {
  std::string bytes;
  encode(imported, [&](const char* more, std::size_t count) { bytes.append(more, count); });
  return bytes;
}

ImportedMesh decode(const ByteSource& source, std::uint64_t at_most) {
  Reader reader(source, at_most);
  ImportedMesh imported;
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    std::string path = reader.take_text();
    imported.companions.push_back({std::move(path), reader.take<std::uint64_t>()});
  }
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    imported.warnings.push_back(reader.take_text());
  }
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    imported.cameras.push_back(reader.take_camera());
  }
  imported.lights = reader.take_list<Light>();
  imported.mesh.vertices = reader.take_list<glm::vec3>();
  imported.mesh.triangles = reader.take_list<std::array<std::uint32_t, 3>>();
  imported.mesh.parts = reader.take_list<MeshPart>();
  imported.motion.frames = reader.take<std::uint32_t>();
  imported.motion.vertices = reader.take_list<MovingVertex>();
  imported.motion.influences = reader.take_list<Influence>();
  imported.motion.matrices = reader.take_list<glm::dmat4>();
  if (!is_consistent(imported.motion, imported.mesh.vertices.size())) {
    throw std::out_of_range("the motion does not match the mesh");
  }
  return imported;
}

ImportedMesh decode(std::string_view bytes) {
  const std::uint64_t size = bytes.size();
  return decode(
      [&](char* into, std::size_t count) {
        std::memcpy(into, bytes.data(), count);  // at most `size` in all are taken
        bytes.remove_prefix(count);
      },
      size);
}

}  // namespace beambench::scenes::mesh
