#include "scenes/formats/mesh/obj_materials.hpp"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <tiny_obj_loader.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/obj_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::string_view kName = "newmtl";

/// The text of a library as tinyobjloader can read it, and the names of its materials.
struct MaterialLibrary {
  std::string text;  ///< each material is called by its index in `names`
  std::vector<std::string> names;
};

/// Leaves out lines whose numbers overflow in tinyobjloader. A material without a color of its own
/// is as gray as Assimp and tinyobjloader make it; the latter only where it has a texture. Of a
/// name with blanks its release candidate 13 reads the first word alone.
MaterialLibrary readable(std::string_view text) {
  MaterialLibrary library;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::string_view words =
        line.substr(std::min(line.find_first_not_of(kBlanks), line.size()));
    const bool is_name = words.size() > kName.size() && words.starts_with(kName) &&
                         kBlanks.find(words[kName.size()]) != std::string_view::npos;
    if (is_name) {
      library.text += fmt::format("newmtl {}\nKd 0.6 0.6 0.6\n", library.names.size());
      library.names.emplace_back(material_name(words.substr(kName.size())));
    } else if (!has_long_exponent(line)) {
      library.text += line;
      library.text += '\n';
    }
  }
  return library;
}

float in_range(float part) { return part >= 0.0F ? std::min(part, 1.0F) : 0.0F; }

Surface surface_of(const tinyobj::material_t& material) {
  Surface surface = clay();
  for (int i = 0; i < 3; ++i) surface.color[i] = in_range(material.diffuse[i]);
  const bool black = surface.color == glm::vec3(0.0F);
  if (black && !material.diffuse_texname.empty()) surface.color = glm::vec3(0.5F);
  surface.transmittance = 1.0F - in_range(material.dissolve);
  return surface;
}

void add_library(std::string_view text, std::map<std::string, Surface>& surfaces) {
  const MaterialLibrary library = readable(text);
  std::istringstream stream(library.text);
  std::map<std::string, int> indices;
  std::vector<tinyobj::material_t> materials;
  std::string warning;
  std::string error;
  tinyobj::LoadMtl(&indices, &materials, &stream, &warning, &error);
  for (std::size_t i = 0; i < library.names.size(); ++i) {
    const auto found = indices.find(fmt::to_string(i));
    if (found == indices.end() || library.names[i].empty()) continue;
    surfaces.emplace(library.names[i],
                     surface_of(materials[static_cast<std::size_t>(found->second)]));
  }
}

/// The files that a line names: one whose name may have blanks, or else several.
std::vector<std::string> files_of(const std::string& line, const MeshCompanions& companions) {
  const std::string whole(material_name(line));
  if (whole.find_first_of(kBlanks) == std::string::npos || companions.has(whole)) return {whole};
  std::istringstream words(whole);
  std::vector<std::string> files;
  for (std::string word; words >> word;) files.push_back(word);
  return files;
}

}  // namespace

std::string_view material_name(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::map<std::string, Surface> obj_surfaces(const std::vector<std::string>& libraries,
                                            MeshCompanions& companions,
                                            std::vector<std::string>& warnings) {
  std::map<std::string, Surface> surfaces;
  for (const std::string& line : libraries) {
    for (const std::string& file : files_of(line, companions)) {
      try {
        add_library(companions.read(file), surfaces);
      } catch (const InputError& error) {
        warnings.push_back(fmt::format("its materials were left out: {}", error.what()));
      }
    }
  }
  return surfaces;
}

}  // namespace beambench::scenes::mesh
