#include "harness/explain/explanation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/inspector_of.hpp"
#include "accel/core/slab_ray.hpp"
#include "harness/explain/display_mesh.hpp"
#include "harness/explain/packed_arrays.hpp"
#include "harness/explain/shown_cells.hpp"
#include "harness/explain/shown_paths.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/light_pencil.hpp"
#include "scenes/base/error.hpp"

namespace beambench::explain {
namespace {

using Json = nlohmann::json;
using Floats = std::vector<float>;
using Counts = std::vector<std::uint32_t>;

/// The maximum number of lights whose pencils a page shows.
constexpr std::size_t kMostLights = 4;

template <class Vector>
Json vector_json(const Vector& v) {
  return {v.x, v.y, v.z};
}

template <class Vector>
void append(Floats& floats, const Vector& v) {
  for (int axis = 0; axis < 3; ++axis) floats.push_back(static_cast<float>(v[axis]));
}

void append(Floats& floats, const accel::Box& box) {
  append(floats, box.lower);
  append(floats, box.upper);
}

template <class Number>
Json add(PackedArrays& arrays, const std::vector<Number>& numbers) {
  return arrays.add(std::span<const Number>(numbers));
}

Json spheres_json(const scenes::Scene& scene, PackedArrays& arrays) {
  Floats spheres;
  Counts primitives;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind != scenes::PrimitiveKind::kSphere) continue;
    append(spheres, scene.spheres[primitive.index].center);
    spheres.push_back(scene.spheres[primitive.index].radius);
    primitives.push_back(id);
  }
  return {{"shapes", add(arrays, spheres)}, {"primitives", add(arrays, primitives)}};
}

/// Corners are integers: the scene's box is divided into 65,535 parts along each axis.
Json mesh_json(const DisplayMesh& mesh, const scenes::Bounds& box, PackedArrays& arrays) {
  constexpr float kParts = 65535.0F;
  const glm::vec3 scale = kParts / glm::max(box.extent(), std::numeric_limits<float>::min());
  std::vector<std::uint16_t> corners;
  for (const glm::vec3& corner : mesh.corners) {
    const glm::vec3 place = glm::clamp((corner - box.lower) * scale, 0.0F, kParts);
    for (int axis = 0; axis < 3; ++axis) {
      corners.push_back(static_cast<std::uint16_t>(std::lround(place[axis])));
    }
  }
  Counts triangles;
  for (const auto& triangle : mesh.triangles) {
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  }
  return {{"corners", add(arrays, corners)},
          {"triangles", add(arrays, triangles)},
          {"primitives", add(arrays, mesh.primitives)},
          {"of", mesh.triangles_of_scene}};
}

Json scene_json(const scenes::Scene& scene, PackedArrays& arrays) {
  Counts surface_of;
  for (const scenes::Primitive& primitive : scene.primitives) {
    surface_of.push_back(primitive.surface);
  }
  Json surfaces = Json::array();
  for (const scenes::Surface& surface : scene.surfaces) {
    surfaces.push_back(vector_json(surface.color));
  }
  Json lights = Json::array();
  for (const scenes::Light& light : scene.lights) lights.push_back(vector_json(light.position));
  return {{"name", scene.name},
          {"primitives", scene.primitives.size()},
          {"lower", vector_json(scene.bounds.lower)},
          {"upper", vector_json(scene.bounds.upper)},
          {"surfaces", std::move(surfaces)},
          {"surface_of", add(arrays, surface_of)},
          {"lights", std::move(lights)},
          {"mesh", mesh_json(display_mesh(scene), scene.bounds, arrays)},
          {"spheres", spheres_json(scene, arrays)}};
}

Json image_json(const rays::ImageOfRays& image) {
  const accel::PrimaryRays rays = image.rays();
  return {{"camera", image.camera.name},
          {"width", rays.width()},
          {"height", rays.height()},
          {"eye", vector_json(rays.eye())},
          {"forward", vector_json(rays.forward())},
          {"up", vector_json(image.camera.up)},
          {"angle", image.camera.angle},
          {"top_left", vector_json(rays.top_left())},
          {"right", vector_json(rays.right())},
          {"down", vector_json(rays.down())}};
}

Json cells_json(const ShownCells& shown, PackedArrays& arrays) {
  Floats boxes;
  Counts levels;
  for (const accel::Cell& cell : shown.cells) {
    append(boxes, cell.box);
    levels.push_back(static_cast<std::uint32_t>(std::max(cell.level, 1)));
  }
  return {{"kind", shown.kind},
          {"of", shown.of},
          {"boxes", add(arrays, boxes)},
          {"levels", add(arrays, levels)}};
}

Json paths_json(const PathTable& paths, PackedArrays& arrays) {
  Floats boxes;
  Json places = Json::array();
  for (const Place& place : paths.places) {
    append(boxes, place.cell.box);
    places.push_back({place.word, place.index, place.cell.level, place.has_box});
  }
  return {{"places", std::move(places)},
          {"boxes", add(arrays, boxes)},
          {"first_step", add(arrays, paths.first_step)},
          {"place", add(arrays, paths.place)},
          {"enter", add(arrays, paths.enter)},
          {"exit", add(arrays, paths.exit)},
          {"first_test", add(arrays, paths.first_test)},
          {"omitted", add(arrays, paths.omitted)},
          {"primitive", add(arrays, paths.primitive)},
          {"t", add(arrays, paths.t)},
          {"first_beam", add(arrays, paths.first_beam)},
          {"beam", add(arrays, paths.beam)},
          {"beam_place", add(arrays, paths.beam_place)}};
}

/// Returns the boxes of the leaves that beams or rays entered, keyed by the leaf's number.
std::map<std::uint64_t, accel::Box> boxes_by_index(const PathTable& paths) {
  std::map<std::uint64_t, accel::Box> boxes;
  for (const Place& place : paths.places) {
    if (place.has_box) boxes.try_emplace(place.index, place.cell.box);
  }
  return boxes;
}

/// Describes beams: their outlines, and the view depth at which each enters its leaf or leaves the
/// scene; infinity if that is unknown.
Json beams_json(const std::vector<accel::BeamOutline>& beams, const accel::PrimaryRays& rays,
                const PathTable& paths, PackedArrays& arrays) {
  const std::map<std::uint64_t, accel::Box> boxes = boxes_by_index(paths);
  std::vector<std::uint8_t> kinds;
  Counts first{0};
  Counts samples;
  Floats corners;
  Floats depths;
  for (const accel::BeamOutline& beam : beams) {
    kinds.push_back(static_cast<std::uint8_t>(beam.kind));
    glm::dvec2 center(0.0);
    for (const glm::dvec2& corner : beam.corners) {
      corners.push_back(static_cast<float>(corner.x));
      corners.push_back(static_cast<float>(corner.y));
      center += corner / static_cast<double>(beam.corners.size());
    }
    first.push_back(static_cast<std::uint32_t>(corners.size() / 2));
    samples.push_back(static_cast<std::uint32_t>(beam.samples.size()));
    const auto leaf = boxes.find(beam.node);
    float depth = accel::kInfinity;
    if (leaf != boxes.end()) {
      const auto [lower, upper] = leaf->second;
      const accel::BoxInterval inside =
          accel::SlabRay(rays.ray_at(center.x, center.y))
              .interval({glm::vec3(lower), glm::vec3(upper)}, 0.0F, accel::kInfinity);
      if (!inside.empty()) {
        depth = beam.kind == accel::BeamKind::kLeaving ? inside.exit : inside.enter;
      }
    }
    depths.push_back(depth);
  }
  return {{"kinds", add(arrays, kinds)},
          {"first", add(arrays, first)},
          {"samples", add(arrays, samples)},
          {"corners", add(arrays, corners)},
          {"depths", add(arrays, depths)}};
}

Json ways_json(const std::vector<accel::BeamPlace>& places, PackedArrays& arrays) {
  std::vector<std::uint8_t> ways;
  std::vector<std::uint8_t> sides;
  Counts beams;
  Counts blocks;
  for (const accel::BeamPlace& place : places) {
    ways.push_back(static_cast<std::uint8_t>(place.way));
    sides.push_back(place.side);
    beams.push_back(place.beam);
    blocks.push_back(place.block);
  }
  return {{"ways", add(arrays, ways)},
          {"sides", add(arrays, sides)},
          {"beams", add(arrays, beams)},
          {"blocks", add(arrays, blocks)}};
}

Json pencils_json(const accel::Accelerator& structure, const scenes::Scene& scene,
                  const accel::PrimaryRays& image, PackedArrays& arrays) {
  Json pencils = Json::array();
  for (std::size_t i = 0; i < std::min(scene.lights.size(), kMostLights); ++i) {
    const render::LightPencil pencil =
        render::light_pencil(structure, scene, image, scene.lights[i]);
    if (pencil.places.empty()) continue;
    Floats origins;
    for (const accel::Ray& ray : pencil.rays) append(origins, ray.origin);
    Json json = ways_json(pencil.places, arrays);
    json["light"] = i;
    json["origins"] = add(arrays, origins);
    json["pixels"] = add(arrays, pencil.samples);
    pencils.push_back(std::move(json));
  }
  return pencils;
}

Json hits_json(const accel::HitBuffer& hits, PackedArrays& arrays) {
  Counts primitives;
  Floats t;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto hit = hits.get(i);
    primitives.push_back(hit ? hit->primitive : scenes::kNoPrimitive);
    t.push_back(hit ? hit->t : accel::kInfinity);
  }
  return {{"primitives", add(arrays, primitives)}, {"t", add(arrays, t)}};
}

std::vector<accel::Cell> cells_of(const PathTable& paths) {
  std::vector<accel::Cell> cells;
  for (const Place& place : paths.places) {
    if (place.has_box) cells.push_back(place.cell);
  }
  return cells;
}

Json structure_json(const scenes::Scene& scene, const rays::ImageOfRays& image,
                    const accel::StructureChoice& choice, PackedArrays& arrays,
                    const std::function<void(double)>& advance) {
  const accel::PrimaryRays rays = image.rays();
  const auto structure = choice.build(scene, rays::workload_of(image, rays));
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  structure->closest_hits(rays, hits, {});  // also creates cells that are built on demand
  rays::HitCheck(scene, choice).require(hits, rays);
  const accel::Inspector& inspector = accel::inspector_of(*structure);
  const std::vector<accel::BeamPlace> places = inspector.places(rays);
  // Where a structure has both, blocks of rays show more than outlines do.
  const auto beams = places.empty() ? inspector.beams(rays) : std::nullopt;
  const PathTable paths =
      follow_image(*structure, rays, beams.value_or(std::vector<accel::BeamOutline>()), advance);
  const accel::Statistics statistics = structure->statistics();
  return {{"label", choice.short_label()},
          {"description", choice.info().summary},
          {"statistics",
           {{"nodes", statistics.nodes},
            {"leaves", statistics.leaves},
            {"empty_leaves", statistics.empty_leaves},
            {"references", statistics.references},
            {"depth", statistics.depth},
            {"bytes", statistics.bytes}}},
          {"hits", hits_json(hits, arrays)},
          {"cells", cells_json(shown_cells(*structure, cells_of(paths)), arrays)},
          {"paths", paths_json(paths, arrays)},
          {"beams", beams ? beams_json(*beams, rays, paths, arrays) : Json()},
          {"tiles", places.empty() ? Json() : ways_json(places, arrays)},
          {"pencils", pencils_json(*structure, scene, rays, arrays)}};
}

}  // namespace

rays::Resolution default_resolution(const scenes::Camera& camera) {
  constexpr double kLongerSide = 96.0;
  const double aspect = camera.aspect;
  const auto side = [&](double share) {
    return std::max(1, static_cast<int>(std::lround(kLongerSide * std::min(1.0, share))));
  };
  return {side(aspect), side(1.0 / aspect)};
}

nlohmann::json explain(const scenes::Scene& scene, const rays::ImageOfRays& image,
                       std::span<const accel::StructureChoice> structures,
                       const std::function<void(double)>& advance) {
  const rays::Resolution& size = image.resolution;
  if (static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) > kMostPixels) {
    throw InputError(fmt::format(
        "a page follows the rays of at most {} pixels, not {}; use --resolution 256x256 or less",
        kMostPixels, rays::to_string(size)));
  }
  if (structures.empty() || structures.size() > 2) {
    throw InputError(
        fmt::format("a page shows one structure, or two side by side, not {}", structures.size()));
  }
  PackedArrays arrays;
  Json page{{"scene", scene_json(scene, arrays)}, {"image", image_json(image)}};
  for (std::size_t i = 0; i < structures.size(); ++i) {
    const auto advance_one = [&](double part) {
      advance((static_cast<double>(i) + part) / static_cast<double>(structures.size()));
    };
    page["structures"].push_back(structure_json(scene, image, structures[i], arrays, advance_one));
  }
  page["arrays"] = arrays.text();
  return page;
}

}  // namespace beambench::explain
