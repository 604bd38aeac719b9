#include "scenes/formats/mesh/mesh_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/fitted_cameras.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::mesh {
namespace {

namespace fs = std::filesystem;

/// A strong light above the camera's left shoulder, and a weak bluish one from its right.
void add_lights(SceneBuilder& builder, const Camera& camera) {
  const glm::dvec3 center(camera.at);
  const glm::dvec3 back = glm::dvec3(camera.from) - center;
  const glm::dvec3 up = glm::length(back) * glm::normalize(glm::dvec3(camera.up));
  const glm::dvec3 right = glm::cross(up, glm::normalize(back));
  const auto add = [&](const glm::dvec3& offset, const glm::dvec3& color) {
    const glm::dvec3 limit(kLargestNumber);
    builder.add_light(glm::clamp(center + offset, -limit, limit), color);
  };
  add(back - 0.7 * right + 0.8 * up, {1.0, 0.97, 0.92});
  add(0.6 * back + 1.0 * right + 0.1 * up, {0.35, 0.38, 0.45});
}

bool has_camera(const GivenView& view, const std::string& name) {
  return std::any_of(view.cameras.begin(), view.cameras.end(),
                     [&](const Camera& camera) { return camera.name == name; });
}

/// Returns the first view, with those cameras of the second that have other names, and with the
/// second's lights if the first has none.
GivenView combined(GivenView first, const GivenView& second) {
  for (const Camera& camera : second.cameras) {
    if (!has_camera(first, camera.name)) first.cameras.push_back(camera);
  }
  if (first.lights.empty()) first.lights = second.lights;
  return first;
}

/// Returns the mesh from the cache, or else reads the file and adds it to the cache.
ImportedMesh cached_import(const fs::path& path, const std::string& ending,
                           std::vector<std::string>& notes) {
  const std::string bytes = read_bytes(path);
  const auto import = [&] {
    const std::string unpacked = is_gzipped(path.string()) ? gunzip(bytes, path) : std::string();
    const std::string& whole = unpacked.empty() ? bytes : unpacked;
    return guarded_import(whole, ending, path, import_limits(whole, ending));
  };
  const auto cache = cache_folder();
  if (!cache) return import();

  const fs::path folder = *cache / "meshes";
  const std::string key = mesh_key(bytes, ending, importer_of(ending));
  CachedMesh cached = find_cached_mesh(folder, key, companion_folder(path));
  if (cached.state == CachedMesh::State::kFound) return std::move(cached.mesh);
  if (cached.state == CachedMesh::State::kDamaged) {
    notes.push_back(
        fmt::format("its copy in the cache {} was damaged and is made again", folder.string()));
  }
  ImportedMesh imported = import();
  if (!cache_mesh(folder, key, imported)) {
    notes.push_back(
        fmt::format("the cache {} cannot be written, so reading the mesh will be as slow next "
                    "time; set BEAMBENCH_CACHE to a writable folder",
                    folder.string()));
  }
  return imported;
}

/// Adds the frames of a mesh to its scene, whose vertices are those of the mesh.
Animation with_frames(Scene scene, MeshMotion motion) {
  if (!motion.moves()) return {std::move(scene)};
  const std::uint32_t frames = motion.frames;
  auto pose = [motion = std::move(motion), vertices = scene.vertices](std::uint32_t frame) {
    Pose moved;
    moved.vertices = vertices_in(motion, frame, vertices);
    return moved;
  };
  return {std::move(scene), frames, std::move(pose)};
}

}  // namespace

void add_view(SceneBuilder& builder, std::span<const glm::vec3> points,
              const Orientation& orientation, const GivenView& given) {
  builder.set_background({0.16, 0.19, 0.24});
  for (const Camera& camera : given.cameras) builder.add_camera(camera);
  const std::vector<Camera> cameras = fitted_cameras(points, orientation);
  for (const Camera& camera : cameras) {
    if (!has_camera(given, camera.name)) builder.add_camera(camera);
  }
  for (const Light& light : given.lights) {
    builder.add_light(glm::dvec3(light.position), glm::dvec3(light.color));
  }
  if (given.lights.empty() && !cameras.empty()) add_lights(builder, cameras.front());
}

Scene mesh_scene(const TriangleMesh& mesh, const std::string& name, const Orientation& orientation,
                 const GivenView& given) {
  SceneBuilder builder(name);
  add_view(builder, mesh.vertices, orientation, given);
  builder.reserve_triangles(mesh.vertices.size(), mesh.triangles.size());
  for (const glm::vec3& vertex : mesh.vertices) builder.add_vertex(vertex);
  auto triangle = mesh.triangles.begin();
  for (const MeshPart& part : mesh.parts) {
    builder.set_surface(part.surface);
    for (std::uint32_t i = 0; i < part.triangle_count; ++i) builder.add_polygon(*triangle++);
  }
  return std::move(builder).build();
}

Animation load_mesh(const MeshRequest& request, std::vector<std::string>* warnings) {
  const std::string file = request.path.string();
  std::vector<std::string> notes;
  ImportedMesh imported = cached_import(request.path, mesh_ending(file), notes);
  if (request.strict && !imported.warnings.empty()) {
    throw InputError(fmt::format("{}: {}; correct the file, or read it without --strict", file,
                                 imported.warnings.front()));
  }
  notes.insert(notes.end(), imported.warnings.begin(), imported.warnings.end());
  if (warnings != nullptr) {
    for (const std::string& note : notes) warnings->push_back(fmt::format("{}: {}", file, note));
  }
  Scene scene = mesh_scene(imported.mesh, request.name, request.orientation,
                           combined(request.view, {imported.cameras, imported.lights}));
  return with_frames(std::move(scene), std::move(imported.motion));
}

void register_mesh(Catalogue& catalogue) {
  using Warnings = std::vector<std::string>;
  catalogue.add_format({[](std::string_view spec) { return spec.starts_with(kMeshPrefix); },
                        [](std::string_view spec, ReadOptions options, Warnings& warnings) {
                          const RegisteredMesh mesh =
                              find_registered_mesh(spec.substr(kMeshPrefix.size()));
                          return load_mesh({mesh.path, std::string(spec), mesh.orientation,
                                            options.strict, mesh.view},
                                           &warnings);
                        }});
  catalogue.add_format({[](std::string_view spec) { return !mesh_ending(spec).empty(); },
                        [](std::string_view spec, ReadOptions options, Warnings& warnings) {
                          return load_mesh({spec, std::string(spec),
                                            usual_orientation(mesh_ending(spec)), options.strict},
                                           &warnings);
                        }});
  // Otherwise its bytes would be reported as a malformed NFF file.
  catalogue.add_format(
      {is_foreign_model, [](std::string_view spec, ReadOptions, Warnings&) -> Animation {
         refuse_foreign_model(spec);
       }});
}

}  // namespace beambench::scenes::mesh
