#include "scenes/formats/mesh/gltf_materials.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/formats/mesh/gltf_file.hpp"
#include "scenes/formats/mesh/importers.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr double kMeanTexture = 0.214;  // linear; encoded for display, it is half of white

double within(double number, double least, double largest) {
  return number >= least ? std::min(number, largest) : least;  // least for NaN
}

/// Returns the sRGB transfer function.
float displayed(double linear) {
  const double light = within(linear, 0.0, 1.0);
  return static_cast<float>(light <= 0.0031308 ? 12.92 * light
                                               : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055);
}

const tinygltf::Value* extension(const tinygltf::Material& material, const std::string& name) {
  const auto found = material.extensions.find(name);
  return found == material.extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

double number_in(const tinygltf::Value& object, const std::string& name, double otherwise) {
  if (!object.Has(name) || !object.Get(name).IsNumber()) return otherwise;
  return object.Get(name).GetNumberAsDouble();
}

/// Linear color and alpha, and whether a texture modifies them.
struct BaseColor {
  glm::dvec4 factor{1.0};
  bool has_texture = false;
};

BaseColor base_color(const tinygltf::Material& material) {
  BaseColor base;
  const auto set = [&](std::size_t i, double value) { base.factor[static_cast<int>(i)] = value; };
  const auto& factors = material.pbrMetallicRoughness.baseColorFactor;
  for (std::size_t i = 0; i < std::min<std::size_t>(factors.size(), 4); ++i) set(i, factors[i]);
  base.has_texture = material.pbrMetallicRoughness.baseColorTexture.index >= 0;
  if (const auto* old = extension(material, "KHR_materials_pbrSpecularGlossiness")) {
    if (old->Has("diffuseFactor") && old->Get("diffuseFactor").IsArray()) {
      const tinygltf::Value& list = old->Get("diffuseFactor");
      for (std::size_t i = 0; i < std::min<std::size_t>(list.ArrayLen(), 4); ++i) {
        const tinygltf::Value& value = list.Get(static_cast<int>(i));
        if (value.IsNumber()) set(i, value.GetNumberAsDouble());
      }
    }
    base.has_texture = base.has_texture || old->Has("diffuseTexture");
  }
  return base;
}

void set_gloss(Surface& surface, const tinygltf::PbrMetallicRoughness& pbr) {
  const double share = pbr.metallicRoughnessTexture.index >= 0 ? 0.5 : 1.0;
  const double roughness = share * within(pbr.roughnessFactor, 0.0, 1.0);
  const double metalness = share * within(pbr.metallicFactor, 0.0, 1.0);
  const double specular = (1.0 - roughness) * (0.2 + 0.6 * metalness);
  surface.specular = static_cast<float>(specular);
  surface.diffuse = static_cast<float>(1.0 - specular);
  surface.shine =
      static_cast<float>(within(2.0 / std::pow(std::max(roughness, 0.01), 4.0) - 2.0, 1.0, 1000.0));
}

void set_transparency(Surface& surface, const tinygltf::Material& material, double alpha) {
  double transmittance = material.alphaMode == "BLEND" ? 1.0 - within(alpha, 0.0, 1.0) : 0.0;
  if (const auto* clear = extension(material, "KHR_materials_transmission")) {
    transmittance =
        std::max(transmittance, within(number_in(*clear, "transmissionFactor", 0.0), 0.0, 1.0));
  }
  surface.transmittance = static_cast<float>(transmittance);
  surface.diffuse *= 1.0F - surface.transmittance;
  if (extension(material, "KHR_materials_volume") == nullptr) return;
  const auto* index = extension(material, "KHR_materials_ior");
  const double refraction = index == nullptr ? 1.5 : number_in(*index, "ior", 1.5);
  surface.refraction_index = static_cast<float>(within(refraction, 1.0, 10.0));
}

}  // namespace

GltfSurface gltf_surface(const tinygltf::Model& model, int material) {
  if (material == -1) return {clay()};
  const tinygltf::Material& found =
      element_of(model.materials, material, "material", "a primitive");
  const BaseColor base = base_color(found);
  const double tint = base.has_texture ? kMeanTexture : 1.0;
  GltfSurface result;
  for (int i = 0; i < 3; ++i) result.surface.color[i] = displayed(tint * base.factor[i]);
  set_gloss(result.surface, found.pbrMetallicRoughness);
  set_transparency(result.surface, found, base.factor.a);
  result.has_mask = found.alphaMode == "MASK" || (found.alphaMode == "BLEND" && base.has_texture);
  return result;
}

}  // namespace beambench::scenes::mesh
