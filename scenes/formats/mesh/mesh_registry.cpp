#include "scenes/formats/mesh/mesh_registry.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/scene_builder.hpp"

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
      names.empty() ? "none is"
                    : fmt::format("{}it has {}", suggestion(name, names), fmt::join(names, ", "));
  throw InputError(fmt::format(
      "no mesh '{}' is registered in {}: {}; scripts/meshes installs cat, bunny, dragon and "
      "others, and any mesh file can be given by its path",
      name, cache ? (*cache / "registered").string() : "a cache folder (set BEAMBENCH_CACHE)",
      there));
}

constexpr std::string_view kRemedy = "correct it, or run scripts/meshes again";

[[noreturn]] void refuse_entry(const fs::path& entry, std::string_view why) {
  throw InputError(fmt::format("{}: {}; {}", entry.string(), why, kRemedy));
}

Json read_json(const fs::path& entry) {
  try {
    return read_json_file<Json>(entry);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; {}", error.what(), kRemedy));
  }
}

/// Returns a string member of an entry, or `otherwise` if the member is missing.
std::string text_of(const Json& json, const char* key, const std::string& otherwise,
                    const fs::path& entry) {
  if (!json.contains(key)) return otherwise;
  if (!json[key].is_string()) refuse_entry(entry, fmt::format("'{}' must be a string", key));
  return json[key].get<std::string>();
}

void read_axis(const Json& json, const char* key, glm::dvec3& axis, const fs::path& entry) {
  if (!json.contains(key)) return;
  const auto given = parse_axis(text_of(json, key, "", entry));
  if (!given) refuse_entry(entry, fmt::format("'{}' must be x, -x, y, -y, z or -z", key));
  axis = *given;
}

glm::dvec3 point_of(const Json& json, std::string_view what, const fs::path& entry) {
  const auto is_number = [](const Json& part) { return part.is_number(); };
  if (!json.is_array() || json.size() != 3 || !std::all_of(json.begin(), json.end(), is_number)) {
    refuse_entry(entry, fmt::format("{} must be three numbers, [x, y, z]", what));
  }
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

Camera camera_of(const Json& json, const glm::dvec3& up, const fs::path& entry) {
  if (!json.is_object()) refuse_entry(entry, "each of 'cameras' must be an object");
  constexpr std::array<std::string_view, 5> kKeys = {"name", "from", "at", "up", "angle"};
  for (const auto& item : json.items()) {
    if (std::find(kKeys.begin(), kKeys.end(), item.key()) == kKeys.end()) {
      refuse_entry(entry, fmt::format("a camera has '{}', but may have only {}", item.key(),
                                      fmt::join(kKeys, ", ")));
    }
  }
  Camera camera;
  camera.name = text_of(json, "name", "", entry);
  if (camera.name.empty()) refuse_entry(entry, "each of 'cameras' must have a 'name'");
  const auto what = [&](const char* key) {
    return fmt::format("'{}' of camera '{}'", key, camera.name);
  };
  const auto point = [&](const char* key) {
    return point_of(json.value(key, Json()), what(key), entry);
  };
  camera.from = point("from");
  camera.at = point("at");
  camera.up = json.contains("up") ? point("up") : up;
  const Json angle = json.value("angle", Json(camera.angle));
  if (!angle.is_number()) refuse_entry(entry, what("angle") + " must be a number of degrees");
  camera.angle = angle.get<float>();
  return camera;
}

/// Returns a list of an entry; an empty list if it is missing.
Json list_of(const Json& json, const char* key, const fs::path& entry) {
  Json list = json.value(key, Json::array());
  if (!list.is_array()) refuse_entry(entry, fmt::format("'{}' must be a list", key));
  return list;
}

GivenView read_view(const Json& json, const Orientation& orientation, const fs::path& entry) {
  GivenView view;
  SceneBuilder checked("");  // refuses views that are invalid in a scene
  try {
    for (const Json& given : list_of(json, "cameras", entry)) {
      const Camera camera = camera_of(given, orientation.up, entry);
      for (const Camera& other : view.cameras) {
        if (other.name == camera.name) {
          refuse_entry(entry, fmt::format("two cameras are named '{}'", camera.name));
        }
      }
      checked.add_camera(camera);
      view.cameras.push_back(camera);
    }
    for (const Json& given : list_of(json, "lights", entry)) {
      const glm::dvec3 place = point_of(given, "each of 'lights'", entry);
      checked.add_light(place);
      view.lights.push_back({glm::vec3(place)});
    }
    // Two lights at full strength are as bright as the fitted ones; more lights share that
    // brightness.
    const std::size_t sharing = std::max<std::size_t>(view.lights.size(), 2);
    for (Light& light : view.lights) light.color = glm::vec3(2.0F / static_cast<float>(sharing));
  } catch (const InputError& error) {
    const std::string_view why = error.what();
    if (why.starts_with(entry.string())) throw;
    refuse_entry(entry, why);
  }
  return view;
}

RegisteredMesh read_entry(const std::string& name, const fs::path& entry) {
  const Json json = read_json(entry);
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
  mesh.view = read_view(json, mesh.orientation, entry);
  mesh.about = printable(text_of(json, "about", "", entry));
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
