#include "scenes/base/nearest_name.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <vector>

#include <fmt/format.h>

namespace beambench {
namespace {

/// A word used by other programs, and beambench's name for the same thing. If a word has several
/// meanings, the one among the candidate names applies, so structures, parameters, scenes, commands
/// and options can share this table.
struct Alias {
  std::string_view word;
  std::string_view name;
};

constexpr std::array kAliases{
    // structures
    Alias{"bih", "sah-bvh"},
    Alias{"brute-force", "exhaustive"},
    Alias{"bruteforce", "exhaustive"},
    Alias{"bvh8", "sah-bvh"},
    Alias{"dda", "voxel-grid"},
    Alias{"linear", "exhaustive"},
    Alias{"naive", "exhaustive"},
    Alias{"none", "null"},
    Alias{"octree", "samet"},
    Alias{"uniform-grid", "voxel-grid"},
    // their parameters
    Alias{"depth", "max_level"},
    Alias{"level", "max_level"},
    Alias{"levels", "max_level"},
    Alias{"max_depth", "max_level"},
    Alias{"objects", "max_objects"},
    // scenes
    Alias{"cat", "gato-bill"},
    Alias{"chess", "ajedrez"},
    Alias{"dolphins", "delfines"},
    Alias{"mountain", "mount"},
    Alias{"random", "soup"},
    Alias{"room", "habitacion"},
    Alias{"snail", "caracol"},
    Alias{"sphereflake", "balls"},
    Alias{"spheres", "balls"},
    Alias{"tetrahedron", "tetra"},
    Alias{"triangles", "soup"},
    // kinds of rays
    Alias{"ambient-occlusion", "diffuse"},
    Alias{"ao", "diffuse"},
    Alias{"camera", "primary"},
    Alias{"eye", "primary"},
    Alias{"mirror", "reflection"},
    Alias{"picture", "whitted"},
    // commands
    Alias{"bench", "run"},
    Alias{"benchmark", "run"},
    Alias{"check", "verify"},
    Alias{"convert", "export"},
    Alias{"draw", "render"},
    Alias{"info", "scene"},
    Alias{"measure", "run"},
    Alias{"picture", "render"},
    Alias{"save", "export"},
    Alias{"test", "verify"},
    Alias{"time", "run"},
    Alias{"validate", "verify"},
    // options
    Alias{"--accelerator", "--accel"},
    Alias{"--algorithm", "--accel"},
    Alias{"--kind", "--rays"},
    Alias{"--out", "-o"},
    Alias{"--output", "-o"},
    Alias{"--position", "--from"},
    Alias{"--res", "--resolution"},
    Alias{"--shading", "--shade"},
    Alias{"--size", "--resolution"},
    Alias{"--spp", "--samples"},
    Alias{"--structure", "--accel"},
    Alias{"--structures", "--accel"},
    Alias{"--target", "--at"},
    Alias{"--view", "--camera"},
    Alias{"-v", "--version"},
    // keys of sweeps
    Alias{"accel", "structures"},
    Alias{"sizes", "resolutions"},
};

std::string alias_of(std::string_view word, std::span<const std::string> names) {
  for (const Alias& alias : kAliases) {
    if (alias.word != word) continue;
    if (std::ranges::find(names, alias.name) != names.end()) return std::string(alias.name);
  }
  return "";
}

/// Returns whether the word is one of the parts of a name: `bvh` of sah-bvh, `level` of max_level.
bool is_part_of(std::string_view word, std::string_view name) {
  constexpr std::string_view kJoints = "-_";
  while (true) {
    const std::size_t end = std::min(name.find_first_of(kJoints), name.size());
    if (name.substr(0, end) == word) return true;
    if (end == name.size()) return false;
    name.remove_prefix(end + 1);
  }
}

/// Returns the only name that contains the word as a part, or an empty string if none or several
/// do.
std::string only_whole_of(std::string_view word, std::span<const std::string> names) {
  std::string whole;
  for (const std::string& name : names) {
    if (!is_part_of(word, name)) continue;
    if (!whole.empty()) return "";
    whole = name;
  }
  return whole;
}

std::string lower_case(std::string_view word) {
  std::string lower(word);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // distance of a's prefix from every prefix of b
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string similar_name(std::string_view word, std::span<const std::string> names) {
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& name : names) {
    if (word.size() > 2 * name.size()) continue;  // more than half would have to be deleted
    const std::size_t distance = edit_distance(word, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  return 2 * least <= word.size() ? nearest : "";
}

}  // namespace

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
  const std::string lower = lower_case(word);
  std::string name = alias_of(lower, names);
  if (name.empty()) name = only_whole_of(lower, names);
  return name.empty() ? similar_name(lower, names) : name;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> names) {
  const std::string name = nearest_name(word, names);
  return name.empty() ? "" : fmt::format("did you mean '{}'? ", name);
}

}  // namespace beambench
