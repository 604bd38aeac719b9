#pragma once
// One tetrahedron in several formats.

#include <string>
#include <utility>
#include <vector>

namespace beambench::scenes {

/// These functions return the tetrahedron with corners (0,0,0), (1,0,0), (0,2,0), (0,0,3).
std::string tetrahedron_obj();
std::string tetrahedron_off();
std::string tetrahedron_ply();
std::string tetrahedron_binary_ply();
std::string tetrahedron_stl();
std::string tetrahedron_binary_stl();
std::string tetrahedron_gltf();
std::string tetrahedron_ac();

/// Returns the tetrahedron in all formats, with file names.
std::vector<std::pair<std::string, std::string>> tetrahedron_files();

std::string base64(const std::string& bytes);

/// Returns the text with `number` as the first coordinate of the corner (1, 0, 0).
std::string with_coordinate(std::string text, const std::string& number);
/// Returns the text with the first occurrence of `old` replaced.
std::string with_count(std::string text, const std::string& old, const std::string& by);

}  // namespace beambench::scenes
