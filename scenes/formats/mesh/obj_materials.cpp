#include "scenes/formats/mesh/obj_materials.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/plain_text.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/obj_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

struct Material {
  std::string name;
  glm::vec3 color{0.6F};  ///< default, as in Assimp and tinyobjloader
  bool has_texture = false;
  std::optional<float> dissolve{};      ///< `d`: 1 is opaque
  std::optional<float> transparency{};  ///< `Tr`, written by some exporters: 0 is opaque
};

float in_range(float part) { return part >= 0.0F ? std::min(part, 1.0F) : 0.0F; }

Surface surface_of(const Material& material) {
  Surface surface = clay();
  for (int i = 0; i < 3; ++i) surface.color[i] = in_range(material.color[i]);
  const bool black = surface.color == glm::vec3(0.0F);
  if (black && material.has_texture) surface.color = glm::vec3(0.5F);
  const float opacity =
      material.dissolve ? *material.dissolve : 1.0F - material.transparency.value_or(0.0F);
  surface.transmittance = 1.0F - in_range(opacity);
  return surface;
}

/// Returns the numbers of a line; nothing if there are none, or a word is not a finite number.
std::optional<std::vector<float>> numbers_of(std::string_view rest) {
  rest = rest.substr(0, rest.find('#'));
  std::vector<float> numbers;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const auto number = number_of<float>(word);
    if (!number || !std::isfinite(*number)) return std::nullopt;
    numbers.push_back(*number);
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

/// Reads `Kd r g b`, or `Kd r` for a gray. Returns false if the line is not understood.
bool read_color(std::string_view rest, glm::vec3& color) {
  const auto numbers = numbers_of(rest);
  if (!numbers || numbers->size() == 2) return false;
  const std::size_t step = numbers->size() == 1 ? 0 : 1;
  color = {numbers->at(0), numbers->at(step), numbers->at(2 * step)};
  return true;
}

/// Reads one number, optionally after `-halo`. Returns false if the line is not understood.
bool read_factor(std::string_view rest, std::optional<float>& factor) {
  std::string_view after = rest;
  const auto numbers = numbers_of(take_word(after) == "-halo" ? after : rest);
  if (!numbers) return false;
  factor = numbers->front();
  return true;
}

/// Reads a line of the material. Returns false if the line is not understood.
bool read_property(std::string_view word, std::string_view rest, Material& material) {
  if (word == "Kd") return read_color(rest, material.color);
  if (word == "d") return read_factor(rest, material.dissolve);
  if (word == "Tr") return read_factor(rest, material.transparency);
  if (word == "map_Kd") material.has_texture = !trimmed(rest).empty();
  return true;
}

/// Adds the material's surface, unless an earlier material has the same name.
void add_material(const Material& material, std::map<std::string, Surface>& surfaces) {
  const Surface surface = surface_of(material);
  surfaces.emplace(material.name, surface);
  surfaces.emplace(without_comment(material.name), surface);
}

UnknownLines add_library(std::string_view text, std::map<std::string, Surface>& surfaces) {
  UnknownLines unknown;
  std::optional<Material> material;  // lines before the first `newmtl` have no material
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    const std::string_view word = take_word(line);
    if (word == "newmtl") {
      if (material) add_material(*material, surfaces);
      material.reset();
      const std::string_view name = trimmed(line);
      if (!name.empty()) material = Material{.name = std::string(name)};
      if (name.empty()) unknown.add(number, word);
    } else if (material && !read_property(word, line, *material)) {
      unknown.add(number, word);
    }
  }
  if (material) add_material(*material, surfaces);
  return unknown;
}

bool has_blank(std::string_view name) {
  return name.find_first_of(" \t") != std::string_view::npos;
}

/// Returns the files that a line names: one file whose name may contain blanks, or else several.
std::vector<std::string> files_of(std::string_view line, MeshCompanions& companions) {
  if (!has_blank(line) || companions.has(line)) return {std::string(line)};
  line = without_comment(line);
  if (companions.has(line)) return {std::string(line)};
  std::vector<std::string> files;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) files.emplace_back(word);
  return files;
}

}  // namespace

std::map<std::string, Surface> obj_surfaces(const std::vector<std::string>& libraries,
                                            MeshCompanions& companions,
                                            std::vector<std::string>& warnings) {
  std::map<std::string, Surface> surfaces;
  for (const std::string& line : libraries) {
    for (const std::string& file : files_of(line, companions)) {
      try {
        const std::string_view text = plain_text(companions.read(file), file);
        const UnknownLines unknown = add_library(text, surfaces);
        if (!unknown.empty()) warnings.push_back(fmt::format("{}: {}", file, unknown.message()));
      } catch (const InputError& error) {
        warnings.push_back(fmt::format("its materials were left out: {}", error.what()));
      }
    }
  }
  return surfaces;
}

}  // namespace beambench::scenes::mesh
