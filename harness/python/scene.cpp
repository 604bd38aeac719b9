// Scenes, their arrays, and their rays.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "accel/core/ray.hpp"
#include "harness/python/arrays.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "harness/python/scene_bytes.hpp"
#include "harness/python/scene_handle.hpp"
#include "harness/python/scene_of_arrays.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::python {

rays::ImageOfRays image_of(const ImageChoice& choice) {
  scenes::SceneBuilder checks("");
  checks.add_camera(choice.camera);
  std::optional<rays::Resolution> resolution;
  if (choice.width != 0 || choice.height != 0) resolution = {choice.width, choice.height};
  return rays::image_of(choice.camera, resolution, choice.samples);
}

namespace {

using Vertices = ArrayIn<double, -1, 3>;
using Triangles = ArrayIn<std::uint32_t, -1, 3>;

// These types store three numbers in consecutive memory.
static_assert(sizeof(glm::dvec3) == 3 * sizeof(double));
static_assert(sizeof(std::array<std::uint32_t, 3>) == 3 * sizeof(std::uint32_t));

std::span<const glm::dvec3> points_of(const Vertices& points) {
  return {reinterpret_cast<const glm::dvec3*>(points.data()), points.shape(0)};
}

std::span<const std::array<std::uint32_t, 3>> triples_of(const Triangles& triangles) {
  return {reinterpret_cast<const std::array<std::uint32_t, 3>*>(triangles.data()),
          triangles.shape(0)};
}

/// Returns the orientation of scenes built from arrays: either the third or the second axis is up.
scenes::mesh::Orientation orientation_of(std::string_view up) {
  if (up == "z") return {{0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};
  if (up == "y") return {};
  throw InputError(fmt::format("up is '{}'; expected 'y' or 'z'", up));
}

SceneHandle handle_of(scenes::Scene scene, std::vector<std::string> warnings = {}) {
  return {std::make_shared<const scenes::Scene>(std::move(scene)), std::move(warnings)};
}

SceneHandle load(const nb::bytes& given, bool strict) {
  const std::string spec = text_of(given);
  const nb::gil_scoped_release released;
  return result_of([=](const StopRequest&) {
    std::vector<std::string> warnings;
    scenes::Scene scene = scenes::load_scene(spec, &warnings, {strict});
    return handle_of(std::move(scene), std::move(warnings));
  });
}

SceneHandle of_triangles(const std::string& name, const Vertices& vertices,
                         const Triangles& triangles, const std::string& up) {
  const nb::gil_scoped_release released;
  return result_of([mesh = mesh_of(points_of(vertices), triples_of(triangles)), name,
                    orientation = orientation_of(up)](const StopRequest&) {
    return handle_of(scenes::mesh::mesh_scene(mesh, name, orientation));
  });
}

SceneHandle of_spheres(const std::string& name, const Vertices& centers,
                       const ArrayIn<double, -1>& radii, const std::string& up) {
  if (centers.shape(0) != radii.shape(0))
    throw InputError("the numbers of radii and centers differ");
  const nb::gil_scoped_release released;
  const auto points = points_of(centers);
  return result_of([own_points = std::vector(points.begin(), points.end()),
                    own_radii = std::vector(radii.data(), radii.data() + radii.shape(0)), name,
                    orientation = orientation_of(up)](const StopRequest&) {
    return handle_of(sphere_scene(name, own_points, own_radii, orientation));
  });
}

nb::bytes pickled(const SceneHandle& handle) {
  std::string bytes;
  {
    const nb::gil_scoped_release released;
    bytes = bytes_of_scene(*handle.scene);
  }
  return nb::bytes(bytes.data(), bytes.size());
}

SceneHandle unpickled(const nb::bytes& given, std::vector<std::string> warnings) {
  const std::string_view bytes(given.c_str(), given.size());  // the caller keeps the bytes alive
  const nb::gil_scoped_release released;
  return handle_of(scene_of_bytes(bytes), std::move(warnings));
}

ArrayOut<std::uint32_t> without_area(const Vertices& vertices, const Triangles& triangles) {
  for (const auto& corners : triples_of(triangles)) {
    for (const std::uint32_t corner : corners) {
      if (corner >= vertices.shape(0)) throw InputError("a corner is not a vertex");
    }
  }
  std::vector<std::uint32_t> found;
  {
    const nb::gil_scoped_release released;
    found = triangles_without_area(points_of(vertices), triples_of(triangles));
  }
  return array_of(std::move(found));
}

/// Returns a part of the scene as an array of rows, without a copy and therefore read-only.
/// `stride` is the distance between rows, in numbers.
template <class T>
ArrayOut<const T> view(const SceneHandle& handle, const T* data,
                       std::initializer_list<std::size_t> shape, std::size_t stride) {
  const std::initializer_list<std::int64_t> of_rows{static_cast<std::int64_t>(stride), 1};
  const std::initializer_list<std::int64_t> of_numbers{static_cast<std::int64_t>(stride)};
  return ArrayOut<const T>(data, shape, keep(handle.scene),
                           shape.size() == 2 ? of_rows : of_numbers);
}

ArrayOut<const float> vertices_of(const SceneHandle& handle) {
  const auto& vertices = handle.scene->vertices;
  return view(handle, reinterpret_cast<const float*>(vertices.data()), {vertices.size(), 3},
              sizeof(glm::vec3) / sizeof(float));
}

constexpr std::size_t kTriangleStride = sizeof(scenes::Triangle) / sizeof(std::uint32_t);

ArrayOut<const std::uint32_t> triangles_of(const SceneHandle& handle) {
  const auto& triangles = handle.scene->triangles;
  const auto* data = triangles.empty() ? nullptr : triangles.front().vertex.data();
  return view(handle, data, {triangles.size(), 3}, kTriangleStride);
}

ArrayOut<const std::uint32_t> triangle_primitives_of(const SceneHandle& handle) {
  const auto& triangles = handle.scene->triangles;
  const auto* data = triangles.empty() ? nullptr : &triangles.front().primitive;
  return view(handle, data, {triangles.size()}, kTriangleStride);
}

ArrayOut<const float> spheres_of(const SceneHandle& handle) {
  const auto& spheres = handle.scene->spheres;
  return view(handle, reinterpret_cast<const float*>(spheres.data()), {spheres.size(), 4},
              sizeof(scenes::Sphere) / sizeof(float));
}

ArrayOut<const std::uint32_t> kinds_of(const SceneHandle& handle) {
  const auto& primitives = handle.scene->primitives;
  return view(handle, reinterpret_cast<const std::uint32_t*>(primitives.data()),
              {primitives.size()}, sizeof(scenes::Primitive) / sizeof(std::uint32_t));
}

ArrayOut<float> bounds_of(const SceneHandle& handle) {
  const scenes::Bounds& bounds = handle.scene->bounds;
  auto kept = std::make_unique<std::array<glm::vec3, 2>>(std::array{bounds.lower, bounds.upper});
  auto* const data = reinterpret_cast<float*>(kept->data());
  return ArrayOut<float>(data, {2, 3}, keep(std::move(kept)));
}

using Triple = std::tuple<float, float, float>;

Triple triple_of(const glm::vec3& v) { return {v.x, v.y, v.z}; }
glm::vec3 vector_of(const Triple& t) { return {std::get<0>(t), std::get<1>(t), std::get<2>(t)}; }

scenes::Camera make_camera(const std::string& name, const Triple& eye, const Triple& at,
                           const Triple& up, float angle, float aspect, int width, int height) {
  scenes::Camera camera;
  camera.name = name;
  camera.from = vector_of(eye);
  camera.at = vector_of(at);
  camera.up = vector_of(up);
  camera.angle = angle;
  camera.aspect = aspect;
  camera.width = width;
  camera.height = height;
  return camera;
}

/// Returns the rays of a kind; generates those of an image here.
std::vector<accel::Ray> make_rays(const scenes::Scene& scene, const rays::ImageOfRays& image,
                                  const rays::RayChoice& choice) {
  const rays::TraceInput input = rays::make_trace_input(scene, image, choice);
  if (input.list() != nullptr) return input.list()->rays;
  std::vector<accel::Ray> rays(input.size());
  input.image()->for_each(0, input.image()->height(),
                          [&](std::size_t index, const accel::Ray& ray) { rays[index] = ray; });
  return rays;
}

ArrayOut<float> rays_of_kind(const SceneHandle& handle, const nb::bytes& given,
                             const ImageChoice& choice) {
  const std::string kind = text_of(given);
  std::shared_ptr<std::vector<accel::Ray>> rays;
  {
    const nb::gil_scoped_release released;
    rays = std::make_shared<std::vector<accel::Ray>>(result_of(
        [scene = handle.scene, image = image_of(choice), parsed = rays::parse_ray_choice(kind)](
            const StopRequest&) { return make_rays(*scene, image, parsed); }));
  }
  return ArrayOut<float>(reinterpret_cast<float*>(rays->data()), {rays->size(), 8}, keep(rays));
}

void bind_camera(nb::module_& module) {
  nb::class_<scenes::Camera>(module, "Camera", "A pinhole camera.")
      .def(nb::new_(&make_camera), nb::arg("name"), nb::arg("eye"), nb::arg("at"), nb::arg("up"),
           nb::arg("angle"), nb::arg("aspect"), nb::arg("width"), nb::arg("height"))
      .def_ro("name", &scenes::Camera::name, "The name by which it is chosen.")
      .def_prop_ro(
          "eye", [](const scenes::Camera& c) { return triple_of(c.from); }, "Its position.")
      .def_prop_ro(
          "at", [](const scenes::Camera& c) { return triple_of(c.at); },
          "The point that it looks at.")
      .def_prop_ro(
          "up", [](const scenes::Camera& c) { return triple_of(c.up); },
          "The upward direction in the image.")
      .def_ro("angle", &scenes::Camera::angle, "Vertical field of view in degrees.")
      .def_ro("aspect", &scenes::Camera::aspect, "Width of the frustum divided by its height.")
      .def_ro("width", &scenes::Camera::width, "Width of the suggested image, in pixels.")
      .def_ro("height", &scenes::Camera::height, "Height of the suggested image, in pixels.");
  nb::class_<ImageChoice>(module, "ImageChoice",
                          "A camera, width and height (0, 0: the camera's own), samples per pixel.")
      .def(nb::init<scenes::Camera, int, int, int>(), nb::arg("camera"), nb::arg("width"),
           nb::arg("height"), nb::arg("samples"));
}

}  // namespace

void bind_scene(nb::module_& module) {
  constexpr auto kOwned = nb::rv_policy::automatic;  // the arrays keep the scene alive themselves
  bind_camera(module);
  nb::class_<SceneHandle>(module, "Scene", "A scene that structures are built over.")
      .def_prop_ro(
          "name", [](const SceneHandle& s) { return s.scene->name; }, "Its label.")
      .def_ro("warnings", &SceneHandle::warnings,
              "Warnings about data that its reader skipped or repaired.")
      .def_prop_ro(
          "primitives", [](const SceneHandle& s) { return s.scene->primitives.size(); },
          "The number of primitives.")
      .def_prop_ro(
          "cameras", [](const SceneHandle& s) { return s.scene->cameras; },
          "The cameras; the first is the default.")
      .def_prop_ro(
          "lights", [](const SceneHandle& s) { return s.scene->lights.size(); },
          "The number of lights.")
      .def_prop_ro(
          "hash",
          [](const SceneHandle& s) { return rays::hex_digits(scenes::scene_hash(*s.scene)); },
          "The hash of everything that rays can hit, as 16 hexadecimal digits.")
      .def_prop_ro("bounds", &bounds_of, kOwned,
                   "Lower and upper corner of the bounding box: (2, 3) float32.")
      .def_prop_ro("vertices", &vertices_of, kOwned, "(V, 3) float32, read-only.")
      .def_prop_ro("triangles", &triangles_of, kOwned,
                   "(T, 3) uint32, indices of vertices, read-only.")
      .def_prop_ro("triangle_primitives", &triangle_primitives_of, kOwned,
                   "(T,) uint32: the primitive of each triangle, read-only.")
      .def_prop_ro("spheres", &spheres_of, kOwned,
                   "(S, 4) float32: center and positive radius, read-only.")
      .def_prop_ro("primitive_kinds", &kinds_of, kOwned,
                   "(P,) uint32: 0 sphere, 1 cone, 2 polygon; read-only.")
      .def("rays", &rays_of_kind, nb::arg("kind"), nb::arg("image"),
           "The rays of a kind: (N, 8) float32.")
      .def("pickled", &pickled, "The whole scene, bit for bit.");
  module.def("unpickled_scene", &unpickled, nb::arg("pickled"), nb::arg("warnings"),
             "The scene stored by `Scene.pickled`.");
  module.def("load_scene", &load, nb::arg("spec"), nb::arg("strict"),
             "A scene by catalogue name or file.");
  module.def("scene_of_triangles", &of_triangles, nb::arg("name"), nb::arg("vertices").noconvert(),
             nb::arg("triangles").noconvert(), nb::arg("up"), "A scene of triangles.");
  module.def("scene_of_spheres", &of_spheres, nb::arg("name"), nb::arg("centers").noconvert(),
             nb::arg("radii").noconvert(), nb::arg("up"), "A scene of spheres.");
  module.def("triangles_without_area", &without_area, nb::arg("vertices").noconvert(),
             nb::arg("triangles").noconvert(), "The rows of triangles without area, as uint32.");
  module.def(
      "require_valid_rays",
      [](const RaysIn& rays) {
        const nb::gil_scoped_release released;
        require_valid_rays(rays_of(rays));
      },
      nb::arg("rays").noconvert(), "Raises InputError naming the first invalid ray.");
}

}  // namespace beambench::python
