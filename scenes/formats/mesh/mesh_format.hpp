#pragma once
// Which files are meshes, by their endings.

#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// The ending of a mesh file's name in lower case, without dot and `.gz`; empty for other files.
std::string mesh_ending(std::string_view file_name);

bool is_gzipped(std::string_view file_name);

/// Whether a path (a text with a slash) has the ending of a model format that cannot be read
/// (`.max`, `.usd`, `.step`...).
bool is_foreign_model(std::string_view path);

/// Throws InputError that lists the formats to convert it to.
[[noreturn]] void refuse_foreign_model(std::string_view path);

}  // namespace beambench::scenes::mesh
