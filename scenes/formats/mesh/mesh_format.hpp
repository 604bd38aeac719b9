#pragma once
// Which files are meshes, by their endings.

#include <span>
#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// The endings of mesh files that can be read, without the dot: `obj`, `ply`, ... Each may be
/// followed by `.gz`.
std::span<const std::string_view> mesh_endings();

/// The ending of a mesh file's name in lower case, without dot and `.gz`; empty for other files.
std::string mesh_ending(std::string_view file_name);

/// The name without the ending of a mesh file: `dragon` of `dragon.ply.gz`.
std::string mesh_stem(std::string_view file_name);

bool is_gzipped(std::string_view file_name);

/// Throws InputError when the ending is that of a model format that cannot be read (`.max`, `.usd`,
/// `.step`...): its bytes would only be reported as a strange NFF file.
void refuse_foreign_format(std::string_view file_name);

}  // namespace beambench::scenes::mesh
