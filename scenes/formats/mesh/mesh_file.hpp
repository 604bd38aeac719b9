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

/// The ending of a mesh file's name in lower case, without dot and `.gz`; empty for other files.
std::string mesh_ending(std::string_view file_name);

bool is_gzipped(std::string_view file_name);

/// Whether a path (a text with a slash) has the ending of a model format that cannot be read
/// (`.max`, `.usd`, `.step`...).
bool is_foreign_model(std::string_view path);

/// Throws InputError that lists the formats to convert it to.
[[noreturn]] void refuse_foreign_model(std::string_view path);

/// No mesh file, unpacked, may be larger: 4 GiB.
inline constexpr std::uint64_t kLargestMeshFile = kLargestFile;

/// Where the companions (material libraries, glTF buffers) of a mesh file lie: beside the file
/// itself, not beside a link to it.
std::filesystem::path companion_folder(const std::filesystem::path& path);

/// Reads a file whole. Throws InputError when it cannot be read, is empty or too large.
std::string read_bytes(const std::filesystem::path& path);

/// What a gzip file's bytes stand for. Throws InputError naming the file when they are damaged or
/// cut off, and as soon as they turn out to stand for more than `kLargestMeshFile`, or for more
/// than 64 MiB that are 200 times as long as what was unpacked, as no mesh is.
std::string gunzip(std::string_view packed, const std::filesystem::path& path);

/// Two axes at right angles: where its top is, and where it faces.
struct Orientation {
  glm::dvec3 up{0.0, 1.0, 0.0};
  glm::dvec3 front{0.0, 0.0, 1.0};
};

/// What is usual in a format: in STL z is up and the front faces -y, in all others y is up and the
/// front faces z.
Orientation usual_orientation(std::string_view ending);

/// `x`, `-x`, `y`, `-y`, `z` or `-z`; nothing for another text.
std::optional<glm::dvec3> parse_axis(std::string_view text);

}  // namespace beambench::scenes::mesh
