#include "scenes/formats/mesh/mesh_format.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kGzip = ".gz";
constexpr std::array<std::string_view, 14> kEndings{"3ds", "ac",  "ase",  "blend", "dae",
                                                    "fbx", "glb", "gltf", "lwo",   "obj",
                                                    "off", "ply", "stl",  "x3d"};
constexpr std::array<std::string_view, 17> kForeign{"3dm", "abc",  "c4d",  "iges", "igs",  "jobj",
                                                    "ma",  "max",  "mb",   "skp",  "step", "stp",
                                                    "usd", "usda", "usdc", "usdz", "wrl"};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// What follows the last dot, in lower case; `.gz` at the end does not count.
std::string last_ending(std::string_view file_name) {
  if (is_gzipped(file_name)) file_name.remove_suffix(kGzip.size());
  const std::size_t dot = file_name.find_last_of("./");
  if (dot == std::string_view::npos || file_name[dot] != '.') return {};
  return lower_case(file_name.substr(dot + 1));
}

template <typename List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

}  // namespace

bool is_gzipped(std::string_view file_name) { return lower_case(file_name).ends_with(kGzip); }

std::string mesh_ending(std::string_view file_name) {
  const std::string ending = last_ending(file_name);
  return contains(kEndings, ending) ? ending : std::string();
}

bool is_foreign_model(std::string_view path) {
  return path.find('/') != std::string_view::npos && contains(kForeign, last_ending(path));
}

void refuse_foreign_model(std::string_view path) {
  throw InputError(
      fmt::format("'{}': .{} files cannot be read; convert it to one of: {} (or write it as NFF)",
                  path, last_ending(path), fmt::join(kEndings, ", ")));
}

}  // namespace beambench::scenes::mesh
