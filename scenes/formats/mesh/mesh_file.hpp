#pragma once
// Mesh files: their endings, their bytes, and the axes of their coordinates.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "scenes/base/files.hpp"

namespace beambench::scenes::mesh {

/// Returns the ending of a mesh file's name in lower case, without dot and `.gz`; empty for other
/// files.
std::string mesh_ending(std::string_view file_name);

bool is_gzipped(std::string_view file_name);

/// Returns whether a path (a string with a slash) has the ending of an unsupported model format
/// (`.max`, `.usd`, `.step`...).
bool is_foreign_model(std::string_view path);

/// Throws InputError with a list of formats to convert the file to.
[[noreturn]] void refuse_foreign_model(std::string_view path);

/// The size limit of an unpacked mesh file: 4 GiB.
inline constexpr std::uint64_t kLargestMeshFile = kLargestFile;

/// Returns the folder of a mesh file's companions (material libraries, glTF buffers): the folder of
/// the file itself, not of a link to it.
std::filesystem::path companion_folder(const std::filesystem::path& path);

/// Reads a whole file. Throws InputError if it cannot be read, is empty or is too large.
std::string read_bytes(const std::filesystem::path& path);

/// Unpacks the bytes of a gzip file. Throws InputError with the file's name if they are damaged or
/// truncated, if they unpack to more than `kLargestMeshFile`, or if they unpack to more than 64 MiB
/// and 200 times their size, which no mesh does.
std::string gunzip(std::string_view packed, const std::filesystem::path& path);

/// The orientation of a mesh as two perpendicular axes: its top and its front.
struct Orientation {
  glm::dvec3 up{0.0, 1.0, 0.0};
  glm::dvec3 front{0.0, 0.0, 1.0};
};

/// Returns the usual orientation in a format: in STL z is up and the front faces -y, in all others
/// y is up and the front faces z.
Orientation usual_orientation(std::string_view ending);

/// Parses `x`, `-x`, `y`, `-y`, `z` or `-z`; returns nothing for any other string.
std::optional<glm::dvec3> parse_axis(std::string_view text);

}  // namespace beambench::scenes::mesh
