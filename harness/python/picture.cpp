// Draws pictures through structures.

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include "accel/core/threads.hpp"
#include "harness/python/arrays.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "harness/python/scene_handle.hpp"
#include "harness/python/stoppable_queries.hpp"
#include "harness/python/structure_handle.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/shading.hpp"
#include "harness/render/whitted.hpp"
#include "harness/render/whitted_picture.hpp"

namespace beambench::python {
namespace {

render::Image draw(const BuiltStructure& built, const rays::ImageOfRays& image,
                   render::Shading shading, int threads, const StopRequest& stop) {
  const StoppableQueries structure(*built.accelerator, stop);
  const accel::PrimaryRays rays = image.rays();
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  structure.closest_hits(rays, hits, {.threads = threads});
  const rays::HitCheck check(*built.scene, built.choice);
  check.require(hits, rays);
  if (shading != render::Shading::kWhitted) {
    return render::shade(*built.scene, rays, hits, shading);
  }
  const render::Whitted tracer(*built.scene, structure, {}, check);
  return render::whitted_picture(tracer, rays, hits, {}, threads).image;
}

ArrayOut<float> render_picture(const StructureHandle& structure, const ImageChoice& choice,
                               const std::string& shading, std::optional<int> threads) {
  std::shared_ptr<render::Image> picture;
  {
    const nb::gil_scoped_release released;
    picture = std::make_shared<render::Image>(
        result_of([built = structure.built, image = image_of(choice),
                   parsed = render::parse_shading(shading), threads](const StopRequest& stop) {
          return draw(*built, image, parsed, threads.value_or(built->threads), stop);
        }));
  }
  return ArrayOut<float>(
      reinterpret_cast<float*>(picture->pixels().data()),
      {static_cast<std::size_t>(picture->height()), static_cast<std::size_t>(picture->width()), 3},
      keep(picture));
}

}  // namespace

void bind_picture(nb::module_& module) {
  module.def("render", &render_picture, nb::arg("structure"), nb::arg("image"), nb::arg("shading"),
             nb::arg("threads").none(), "Linear light: (height, width, 3) float32.");
}

}  // namespace beambench::python
