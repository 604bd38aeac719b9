#include "scenes/scene_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "scenes/base/error.hpp"
#include "scenes/base/portable_math.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/triangulate.hpp"

namespace beambench::scenes {
namespace {

constexpr int kLargestResolution = 65535;

/// The subject of an error message; formatted only if there is an error.
struct Subject {
  const char* words;  // "sphere (primitive {})"
  std::size_t number;
};

std::string message(const Subject& subject, const std::string& why) {
  return fmt::format(fmt::runtime(subject.words), subject.number) + ": " + why;
}

[[noreturn]] void refuse(const Subject& subject, const std::string& why) {
  throw InputError(message(subject, why));
}

[[noreturn]] void refuse_degenerate(const Subject& subject, const std::string& why) {
  throw DegeneratePrimitive(message(subject, why));
}

/// Rounds once to float; -0 becomes 0, so that equal scenes have equal bits.
float rounded(double number, const Subject& subject, const char* what) {
  if (!(std::abs(number) <= kLargestNumber)) {  // also catches NaN
    refuse(subject,
           fmt::format("the {} is {}, but must be a number from -1e9 to 1e9", what, number));
  }
  return static_cast<float>(number) + 0.0F;
}

glm::vec3 rounded(const glm::dvec3& point, const Subject& subject, const char* what) {
  return {rounded(point.x, subject, what), rounded(point.y, subject, what),
          rounded(point.z, subject, what)};
}

std::uint32_t index_32(std::size_t index, const Subject& subject) {
  if (index >= std::numeric_limits<std::uint32_t>::max()) {
    refuse(subject, "the scene is too large for 32-bit indices; use fewer primitives");
  }
  return static_cast<std::uint32_t>(index);
}

/// The corners of a polygon, with consecutive coincident corners merged into the first of them.
struct MergedCorners {
  std::vector<std::uint32_t> vertices;
  std::vector<glm::vec3> positions;
  std::vector<std::size_t> sources;  ///< position in the caller's list
};

MergedCorners merge_corners(std::span<const std::uint32_t> vertices,
                            std::span<const glm::vec3> scene_vertices, const Subject& subject) {
  MergedCorners merged;
  merged.vertices.reserve(vertices.size());
  merged.positions.reserve(vertices.size());
  merged.sources.reserve(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] >= scene_vertices.size()) {
      refuse(subject, fmt::format("corner {} is vertex {}, but there are only {} vertices", i,
                                  vertices[i], scene_vertices.size()));
    }
    const glm::vec3 position = scene_vertices[vertices[i]];
    if (!merged.positions.empty() && merged.positions.back() == position) continue;
    merged.vertices.push_back(vertices[i]);
    merged.positions.push_back(position);
    merged.sources.push_back(i);
  }
  while (merged.positions.size() > 1 && merged.positions.front() == merged.positions.back()) {
    merged.vertices.pop_back();
    merged.positions.pop_back();
    merged.sources.pop_back();
  }
  return merged;
}

/// Returns Newell's normal of the corners.
glm::dvec3 polygon_normal(std::span<const glm::vec3> corners) {
  glm::dvec3 normal(0.0);
  const glm::dvec3 origin(corners.front());
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[i + 1]) - origin);
  }
  return glm::normalize(normal);
}

/// Returns the merged corners' normals; `replaced` counts replaced normals of length 0.
std::vector<glm::vec3> corner_normals(const MergedCorners& corners,
                                      std::span<const glm::dvec3> normals, const Subject& subject,
                                      std::size_t& replaced) {
  std::vector<glm::vec3> kept;
  kept.reserve(corners.sources.size());
  for (const std::size_t source : corners.sources) {
    glm::vec3 normal = rounded(normals[source], subject, "normal");
    if (normal == glm::vec3(0.0F)) {
      normal = rounded(polygon_normal(corners.positions), subject, "normal");
      ++replaced;
    }
    kept.push_back(normal);
  }
  return kept;
}

/// Throws if a camera's name is not plain: names are typed on command lines and written on a line
/// of NFF.
void require_plain_name(const std::string& name, const Subject& subject) {
  const bool plain = std::none_of(
      name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == '\x7F' || c == '#'; });
  if (!plain || name.empty() || name.front() == ' ' || name.back() == ' ') {
    refuse(subject, fmt::format("the name is '{}', but must be a line of text without '#' and "
                                "without blanks at its ends",
                                excerpt(name)));
  }
}

template <typename T>
void append(std::vector<T>& list, const std::vector<T>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Returns an eye at that distance from the center, within the coordinate limit. If there is not
/// enough room, the eye is on the origin's side of the center, or closer to it.
glm::dvec3 fitted_eye(const glm::dvec3& center, double distance) {
  glm::dvec3 direction = glm::normalize(glm::dvec3(1.0, 0.8, 1.3));
  double room = distance;
  for (int axis = 0; axis < 3; ++axis) {
    const bool too_far = center[axis] + distance * direction[axis] > kLargestNumber;
    if (too_far && center[axis] > 0.0) direction[axis] = -direction[axis];
    const double beside = kLargestNumber - std::copysign(1.0, direction[axis]) * center[axis];
    room = std::min(room, beside / std::abs(direction[axis]));
  }
  return center + room * direction;
}

Camera fitted_camera(const Bounds& bounds) {
  Camera camera;
  camera.up = {0.0F, 0.0F, 1.0F};
  const glm::dvec3 lower(bounds.empty() ? glm::vec3(-1.0F) : bounds.lower);
  const glm::dvec3 upper(bounds.empty() ? glm::vec3(1.0F) : bounds.upper);
  const glm::dvec3 center = 0.5 * (lower + upper);
  // The sphere around the box fills the frustum; far from the origin it is kept large enough for
  // the eye to differ from the center in float.
  const glm::dvec3 farthest = glm::max(glm::abs(lower), glm::abs(upper));
  const double radius = std::max(0.5 * glm::length(upper - lower), 1e-5 * glm::length(farthest));
  const double distance =
      radius / portable_sin(0.5 * glm::radians(static_cast<double>(camera.angle)));
  camera.from = fitted_eye(center, distance);
  camera.at = center;
  return camera;
}

}  // namespace

SceneBuilder::SceneBuilder(std::string_view name) { scene_.name = printable(name); }

void SceneBuilder::set_surface(const Surface& surface) {
  const Subject subject{"surface {}", scene_.surfaces.size()};
  Surface checked = surface;
  checked.color = rounded(glm::dvec3(surface.color), subject, "color");
  for (float* factor : {&checked.diffuse, &checked.specular, &checked.shine, &checked.transmittance,
                        &checked.refraction_index}) {
    *factor = rounded(*factor, subject, "factor");
  }
  surface_ = checked;
  surface_index_.reset();
}

void SceneBuilder::set_background(const glm::dvec3& color) {
  scene_.background = rounded(color, {"background", 0}, "color");
}

void SceneBuilder::add_light(const glm::dvec3& position, const glm::dvec3& color) {
  const Subject subject{"light {}", scene_.lights.size()};
  scene_.lights.push_back(
      {rounded(position, subject, "position"), rounded(color, subject, "color")});
}

void SceneBuilder::add_camera(const Camera& camera) {
  const Subject subject{"camera {}", scene_.cameras.size()};
  const glm::dvec3 view = rounded(glm::dvec3(camera.at), subject, "point looked at") -
                          rounded(glm::dvec3(camera.from), subject, "eye");
  const glm::dvec3 up = rounded(glm::dvec3(camera.up), subject, "up vector");
  rounded(camera.hither, subject, "hither distance");
  require_plain_name(camera.name, subject);
  if (!(camera.angle > 0.0F && camera.angle < 180.0F)) {
    refuse(subject,
           fmt::format("the angle is {}, but must be between 0 and 180 degrees", camera.angle));
  }
  if (!(camera.aspect >= 1e-3F && camera.aspect <= 1e3F)) {
    refuse(subject, fmt::format("the aspect is {}, but must be from 0.001 to 1000", camera.aspect));
  }
  if (std::min(camera.width, camera.height) < 1 ||
      std::max(camera.width, camera.height) > kLargestResolution) {
    refuse(subject, fmt::format("the resolution is {} x {}, but each must be from 1 to {}",
                                camera.width, camera.height, kLargestResolution));
  }
  if (view == glm::dvec3(0.0)) {
    refuse(subject, "the eye is the point looked at; move one of them");
  }
  if (!(glm::length(glm::cross(view, up)) > 1e-6 * glm::length(view) * glm::length(up))) {
    refuse(subject, "the up vector is 0 or parallel to the view; turn it");
  }
  scene_.cameras.push_back(camera);
  scene_.cameras.back().name = printable(camera.name);
}

void SceneBuilder::add_sphere(const glm::dvec3& center, double radius) {
  const Subject subject{"sphere (primitive {})", primitive_count()};
  const glm::vec3 place = rounded(center, subject, "center");
  const float size = rounded(radius, subject, "radius");
  if (size == 0.0F) {
    refuse_degenerate(
        subject,
        "the radius is 0 in single precision, but must be positive, or negative for a "
        "sphere seen from the inside only");
  }
  add_primitive(PrimitiveKind::kSphere, scene_.spheres.size());
  scene_.spheres.push_back({place, std::abs(size), size < 0.0F});
}

void SceneBuilder::add_cone(const glm::dvec3& base, double base_radius, const glm::dvec3& apex,
                            double apex_radius) {
  const Subject subject{"cone (primitive {})", primitive_count()};
  const glm::vec3 from = rounded(base, subject, "base");
  const glm::vec3 to = rounded(apex, subject, "apex");
  const float from_radius = rounded(base_radius, subject, "base radius");
  const float to_radius = rounded(apex_radius, subject, "apex radius");
  if (from_radius == 0.0F && to_radius == 0.0F) {
    refuse_degenerate(subject, "both radii are 0 in single precision, but one must not be");
  }
  const auto [least, largest] = std::minmax(from_radius, to_radius);
  if (least < 0.0F && largest > 0.0F) {
    refuse(subject, fmt::format("the radii {} and {} differ in sign; make both positive, or both "
                                "negative for a cone seen from the inside only",
                                base_radius, apex_radius));
  }
  if (from == to) {
    refuse_degenerate(subject,
                      "base and apex are the same point in single precision; move one of them");
  }
  add_primitive(PrimitiveKind::kCone, scene_.cones.size());
  scene_.cones.push_back({from, std::abs(from_radius), to, std::abs(to_radius), least < 0.0F});
}

void SceneBuilder::reserve_triangles(std::size_t vertices, std::size_t triangles) {
  scene_.vertices.reserve(scene_.vertices.size() + vertices);
  scene_.corners.reserve(scene_.corners.size() + 3 * triangles);
  scene_.triangles.reserve(scene_.triangles.size() + triangles);
  scene_.polygons.reserve(scene_.polygons.size() + triangles);
  scene_.primitives.reserve(scene_.primitives.size() + triangles);
}

std::uint32_t SceneBuilder::add_vertex(const glm::dvec3& position) {
  const Subject subject{"vertex {}", scene_.vertices.size()};
  const std::uint32_t index = index_32(scene_.vertices.size(), subject);
  scene_.vertices.push_back(rounded(position, subject, "position"));
  return index;
}

void SceneBuilder::add_polygon(std::span<const std::uint32_t> vertices,
                               std::span<const glm::dvec3> normals) {
  if (vertices.size() == 3 && normals.empty() && add_flat_triangle(vertices)) return;
  const Subject subject{"polygon (primitive {})", primitive_count()};
  if (vertices.size() < 3) {
    refuse_degenerate(subject,
                      fmt::format("it has {} corners, but must have at least 3", vertices.size()));
  }
  if (!normals.empty() && normals.size() != vertices.size()) {
    refuse(subject,
           fmt::format("it has {} normals for {} corners; give one for each corner, or none",
                       normals.size(), vertices.size()));
  }
  const MergedCorners corners = merge_corners(vertices, scene_.vertices, subject);
  if (corners.vertices.size() < 3) {
    refuse_degenerate(
        subject, fmt::format("only {} of its {} corners differ in single precision, but 3 must",
                             corners.vertices.size(), vertices.size()));
  }
  const auto triangles = triangulate(corners.positions);
  if (triangles.empty()) {
    refuse_degenerate(subject,
                      "it has no area: its corners are collinear, or it crosses itself; remove it");
  }
  std::size_t replaced = 0;
  std::vector<glm::vec3> kept_normals;
  if (!normals.empty()) kept_normals = corner_normals(corners, normals, subject, replaced);

  index_32(scene_.corners.size() + corners.vertices.size(), subject);
  const PrimitiveId id = index_32(primitive_count(), subject);
  Polygon polygon{};
  polygon.first_corner = static_cast<std::uint32_t>(scene_.corners.size());
  polygon.corner_count = static_cast<std::uint32_t>(corners.vertices.size());
  polygon.first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
  polygon.triangle_count = static_cast<std::uint32_t>(triangles.size());
  polygon.first_normal =
      normals.empty() ? Polygon::kFlat : static_cast<std::uint32_t>(scene_.normals.size());
  add_primitive(PrimitiveKind::kPolygon, scene_.polygons.size());
  scene_.polygons.push_back(polygon);
  repairs_.merged_corners += vertices.size() - corners.vertices.size();
  repairs_.replaced_normals += replaced;
  append(scene_.corners, corners.vertices);
  append(scene_.normals, kept_normals);
  for (const auto& [a, b, c] : triangles) {
    scene_.triangles.push_back(
        {{corners.vertices[a], corners.vertices[b], corners.vertices[c]}, id});
  }
}

bool SceneBuilder::add_flat_triangle(std::span<const std::uint32_t> vertices) {
  const std::array<std::uint32_t, 3> corners{vertices[0], vertices[1], vertices[2]};
  if (*std::max_element(corners.begin(), corners.end()) >= scene_.vertices.size()) return false;
  // This also excludes triangles with two corners at the same place, which have no area.
  const auto at = [&](std::size_t i) { return scene_.vertices[corners[i]]; };
  if (!has_area(at(0), at(1), at(2))) return false;
  const std::size_t first_corner = scene_.corners.size();
  if (first_corner + 3 >= std::numeric_limits<std::uint32_t>::max()) return false;

  const auto id = static_cast<PrimitiveId>(primitive_count());
  const auto first_triangle = static_cast<std::uint32_t>(scene_.triangles.size());
  add_primitive(PrimitiveKind::kPolygon, scene_.polygons.size());
  scene_.polygons.push_back(
      {static_cast<std::uint32_t>(first_corner), 3, first_triangle, 1, Polygon::kFlat});
  scene_.corners.insert(scene_.corners.end(), corners.begin(), corners.end());
  scene_.triangles.push_back({corners, id});
  return true;
}

void SceneBuilder::add_polygon(std::span<const glm::dvec3> vertices,
                               std::span<const glm::dvec3> normals) {
  const Subject subject{"polygon (primitive {})", primitive_count()};
  std::vector<glm::vec3> positions;
  positions.reserve(vertices.size());
  for (const glm::dvec3& vertex : vertices) positions.push_back(rounded(vertex, subject, "corner"));

  const std::size_t first = scene_.vertices.size();
  std::vector<std::uint32_t> indices(vertices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = index_32(first + i, subject);
  append(scene_.vertices, positions);
  try {
    add_polygon(indices, normals);
  } catch (const InputError&) {
    scene_.vertices.resize(first);
    throw;
  }
}

std::uint32_t SceneBuilder::current_surface() {
  if (surface_index_) return *surface_index_;
  // Generators cycle through a few surfaces millions of times, so only recent surfaces are reused.
  constexpr std::size_t kRemembered = 64;
  auto& surfaces = scene_.surfaces;
  const auto oldest =
      surfaces.end() - static_cast<std::ptrdiff_t>(std::min(surfaces.size(), kRemembered));
  auto found = std::find(oldest, surfaces.end(), surface_);
  if (found == surfaces.end()) found = surfaces.insert(found, surface_);
  surface_index_ = static_cast<std::uint32_t>(found - surfaces.begin());
  return *surface_index_;
}

void SceneBuilder::add_primitive(PrimitiveKind kind, std::size_t index) {
  index_32(primitive_count(), {"primitive {}", primitive_count()});
  scene_.primitives.push_back({kind, static_cast<std::uint32_t>(index), current_surface()});
}

Scene SceneBuilder::build() && {
  scene_.bounds = bounds_of_all(scene_);
  const std::string fault = extent_fault(scene_.bounds);
  if (!fault.empty()) throw InputError(fmt::format("scene '{}': {}", scene_.name, fault));
  if (scene_.cameras.empty()) scene_.cameras.push_back(fitted_camera(scene_.bounds));
  return std::move(scene_);
}

std::string extent_fault(const Bounds& bounds) {
  if (bounds.empty()) return "";
  const double diagonal = glm::length(glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
  if (diagonal >= kMinExtent) return "";
  return fmt::format(
      "the diagonal of its box is {:.3g}, but must be at least {:g}, or products of lengths leave "
      "the range of single precision; scale it up, cameras and lights with it",
      diagonal, kMinExtent);
}

}  // namespace beambench::scenes
