#include "scenes/formats/mesh/mesh_registry.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"
#include "scenes/core/nearest_name.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::string_view kEntry = ".json";

std::string suggestion(std::string_view name, const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return nearest.empty() ? "" : fmt::format("did you mean '{}{}'? ", kMeshPrefix, nearest);
}

[[noreturn]] void refuse_name(std::string_view name, const std::vector<std::string>& names) {
  const auto cache = cache_folder();
  const std::string there =
      names.empty()
          ? "none is"
          : fmt::format("{}registered are {}", suggestion(name, names), fmt::join(names, ", "));
  throw InputError(fmt::format(
      "no mesh '{}' is registered in {}: {}; scripts/meshes installs cat, bunny, dragon and "
      "others, and any mesh file can be given by its path",
      name, cache ? (*cache / "registered").string() : "a cache folder (set BEAMBENCH_CACHE)",
      there));
}

[[noreturn]] void refuse_entry(const fs::path& entry, std::string_view why) {
  throw InputError(
      fmt::format("{}: {}; correct it, or run scripts/meshes again", entry.string(), why));
}

/// A text of an entry; the other one where it is not given.
std::string text_of(const Json& json, const char* key, const std::string& otherwise,
                    const fs::path& entry) {
  if (!json.contains(key)) return otherwise;
  if (!json[key].is_string()) refuse_entry(entry, fmt::format("'{}' must be a text", key));
  return json[key].get<std::string>();
}

void read_axis(const Json& json, const char* key, glm::dvec3& axis, const fs::path& entry) {
  if (!json.contains(key)) return;
  const auto given = parse_axis(text_of(json, key, "", entry));
  if (!given) refuse_entry(entry, fmt::format("'{}' must be x, -x, y, -y, z or -z", key));
  axis = *given;
}

RegisteredMesh read_entry(const std::string& name, const fs::path& entry) {
  const Json json = Json::parse(read_input(entry), nullptr, false);
  if (!json.is_object()) refuse_entry(entry, "it is not a JSON object");
  RegisteredMesh mesh;
  mesh.name = name;
  mesh.path = (entry.parent_path() / text_of(json, "path", "", entry)).lexically_normal();
  const std::string ending = mesh_ending(mesh.path.string());
  if (ending.empty()) refuse_entry(entry, "'path' must be the path of a mesh file");
  mesh.orientation = usual_orientation(ending);
  read_axis(json, "up", mesh.orientation.up, entry);
  read_axis(json, "front", mesh.orientation.front, entry);
  if (glm::dot(mesh.orientation.up, mesh.orientation.front) != 0.0) {
    refuse_entry(entry, "'up' and 'front' must be two different axes; give both");
  }
  mesh.about = text_of(json, "about", "", entry);
  return mesh;
}

}  // namespace

std::vector<std::string> registered_mesh_names() {
  std::vector<std::string> names;
  const auto cache = cache_folder();
  std::error_code error;
  if (!cache) return names;
  for (const auto& entry : fs::directory_iterator(*cache / "registered", error)) {
    const fs::path& path = entry.path();
    const bool hidden = path.filename().string().starts_with('.');  // being written
    if (path.extension() == kEntry && !hidden) names.push_back(path.stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

RegisteredMesh find_registered_mesh(std::string_view name) {
  const std::vector<std::string> names = registered_mesh_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) refuse_name(name, names);
  return read_entry(*found, *cache_folder() / "registered" / (*found + std::string(kEntry)));
}

}  // namespace beambench::scenes::mesh
