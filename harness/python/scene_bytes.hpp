#pragma once
// Converts scenes to bytes, for pickle.

#include <string>
#include <string_view>

#include "scenes/scene.hpp"

namespace beambench::python {

/// Returns the bytes of a whole scene, bit for bit.
std::string bytes_of_scene(const scenes::Scene& scene);

/// Returns the scene stored in these bytes. Throws InputError for bytes from another version of
/// beambench and for damaged bytes. Like pickle itself, it trusts the source of the bytes.
scenes::Scene scene_of_bytes(std::string_view bytes);

}  // namespace beambench::python
