#pragma once
// The bytes of mesh files.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace beambench::scenes::mesh {

/// No mesh file, unpacked, may be larger: 4 GiB.
inline constexpr std::uint64_t kLargestMeshFile = std::uint64_t{4} << 30U;

/// Where the companions (material libraries, glTF buffers) of a mesh file lie: beside the file
/// itself, not beside a link to it.
std::filesystem::path companion_folder(const std::filesystem::path& path);

/// Reads a file whole. Throws InputError when it cannot be read, is empty or too large.
std::string read_bytes(const std::filesystem::path& path);

/// What a gzip file's bytes stand for. Throws InputError naming the file when they are damaged, cut
/// off, or stand for too much.
std::string gunzip(std::string_view packed, const std::filesystem::path& path);

}  // namespace beambench::scenes::mesh
