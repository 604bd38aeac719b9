// Pages that show how structures trace a scene.

#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "accel/core/registry.hpp"
#include "harness/explain/explain_page.hpp"
#include "harness/explain/explanation.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "harness/python/scene_handle.hpp"

namespace beambench::python {
namespace nb = nanobind;

namespace {

std::string explain_html(const SceneHandle& scene, const std::string& structures,
                         ImageChoice choice) {
  if (choice.width == 0) {
    const rays::Resolution size = explain::default_resolution(choice.camera);
    choice.width = size.width;
    choice.height = size.height;
  }
  const nb::gil_scoped_release released;
  return result_of([scene = scene.scene, image = image_of(choice),
                    choices = accel::registry().choose_list(structures)](const StopRequest& stop) {
    return explain::explain_page(
        explain::explain(*scene, image, choices, [&](double) { stop.check(); }));
  });
}

}  // namespace

void bind_explain(nb::module_& module) {
  module.def("explain_html", &explain_html, nb::arg("scene"), nb::arg("structures"),
             nb::arg("image"), "A self-contained page.");
}

}  // namespace beambench::python
