#pragma once
// The parts of the extension `_beambench`. Its functions are called by the Python files of the
// package, which check and convert the users' arguments and contain the documentation.

#include <string>

#include <nanobind/nanobind.h>

namespace beambench::python {

/// A dict with names as keys and values of several types, and a list of such dicts; typed for the
/// stubs.
using Record = nanobind::typed<nanobind::dict, nanobind::str, nanobind::any>;
using Records = nanobind::typed<nanobind::list, Record>;

/// Returns a name or a path, as encoded by Python's `os.fsencode`: any bytes, UTF-8 or not.
inline std::string text_of(const nanobind::bytes& given) { return {given.c_str(), given.size()}; }

void bind_analysis(nanobind::module_& module);
void bind_catalogue(nanobind::module_& module);
void bind_scene(nanobind::module_& module);
void bind_structure(nanobind::module_& module);
void bind_picture(nanobind::module_& module);
void bind_explain(nanobind::module_& module);
void bind_verify(nanobind::module_& module);
void bind_sweep(nanobind::module_& module);

}  // namespace beambench::python
