// The extension module: error types and all parts.

#include <exception>
#include <filesystem>
#include <new>

#include <nanobind/nanobind.h>

#include "harness/measure/record/machine.hpp"
#include "harness/python/bindings.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/primitive.hpp"

NB_MODULE(_beambench, module) {
  namespace nb = nanobind;
  module.doc() =
      "The compiled part of beambench. Use the package `beambench`, which checks and converts "
      "what\n"
      "its arguments and documents everything.";
  // A program that exits with a daemon thread keeps everything reachable from that thread; that is
  // not a leak.
  nb::set_leak_warnings(false);
  const nb::exception<beambench::InputError> input_error(module, "InputError", PyExc_ValueError);
  input_error.attr("__doc__") =
      "Invalid input: a name, a parameter, a file or a number. The message is one sentence that\n"
      "states where the problem is, what was expected and what to do.";
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::filesystem::filesystem_error& error) {
      PyErr_SetString(PyExc_OSError, beambench::message_line(error.what()).c_str());
    }
  });
  const std::string_view version = beambench::measure::build_info().version;
  module.def(
      "version", [version] { return nb::str(version.data(), version.size()); },
      "The program's version.");
  module.attr("NO_PRIMITIVE") = beambench::scenes::kNoPrimitive;

  beambench::python::bind_analysis(module);
  beambench::python::bind_catalogue(module);
  beambench::python::bind_scene(module);
  beambench::python::bind_structure(module);
  beambench::python::bind_picture(module);
  beambench::python::bind_explain(module);
  beambench::python::bind_verify(module);
  beambench::python::bind_sweep(module);
}
