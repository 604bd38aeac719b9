#include "scenes/formats/mesh/mesh.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace beambench::scenes::mesh {
namespace {

/// Appends numbers, texts and lists to bytes.
class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <typename T>
  void put_list(const std::vector<T>& list) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t{list.size()});
    if (!list.empty()) {
      bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
    }
  }
  void put_text(const std::string& text) {
    put(std::uint64_t{text.size()});
    bytes_ += text;
  }
  void reserve(std::size_t size) { bytes_.reserve(size); }
  std::string take_bytes() && { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Takes them off again; throws std::out_of_range where they are not there.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  T take() {
    T value;
    std::memcpy(&value, take_bytes(1, sizeof(T)).data(), sizeof(T));
    return value;
  }
  template <typename T>
  std::vector<T> take_list() {
    const std::string_view bytes = take_bytes(take<std::uint64_t>(), sizeof(T));
    std::vector<T> list(bytes.size() / sizeof(T));
    if (!list.empty()) std::memcpy(list.data(), bytes.data(), bytes.size());
    return list;
  }
  std::string take_text() { return std::string(take_bytes(take<std::uint64_t>(), 1)); }

 private:
  std::string_view take_bytes(std::uint64_t count, std::size_t each) {
    if (count > bytes_.size() / each) throw std::out_of_range("the file ends too early");
    const std::string_view taken = bytes_.substr(0, count * each);
    bytes_.remove_prefix(taken.size());
    return taken;
  }

  std::string_view bytes_;
};

}  // namespace

std::string encode(const ImportedMesh& imported) {
  Writer writer;
  writer.reserve(imported.mesh.vertices.size() * sizeof(glm::vec3) +
                 imported.mesh.triangles.size() * 3 * sizeof(std::uint32_t) + 4096);
  writer.put(std::uint64_t{imported.companions.size()});
  for (const MeshCompanion& companion : imported.companions) {
    writer.put_text(companion.path);
    writer.put(companion.hash);
  }
  writer.put(std::uint64_t{imported.warnings.size()});
  for (const std::string& warning : imported.warnings) writer.put_text(warning);
  writer.put_list(imported.mesh.vertices);
  writer.put_list(imported.mesh.triangles);
  writer.put_list(imported.mesh.parts);
  return std::move(writer).take_bytes();
}

ImportedMesh decode(std::string_view bytes) {
  Reader reader(bytes);
  ImportedMesh imported;
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    std::string path = reader.take_text();
    imported.companions.push_back({std::move(path), reader.take<std::uint64_t>()});
  }
  for (auto left = reader.take<std::uint64_t>(); left > 0; --left) {
    imported.warnings.push_back(reader.take_text());
  }
  imported.mesh.vertices = reader.take_list<glm::vec3>();
  imported.mesh.triangles = reader.take_list<std::array<std::uint32_t, 3>>();
  imported.mesh.parts = reader.take_list<MeshPart>();
  return imported;
}

}  // namespace beambench::scenes::mesh
