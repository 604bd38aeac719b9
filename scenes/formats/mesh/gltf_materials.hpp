#pragma once
// Surfaces from the materials of a glTF file.

#include <tiny_gltf.h>

#include "scenes/surface.hpp"

namespace beambench::scenes::mesh {

/// A material as a surface of a scene, and whether the conversion ignores holes.
struct GltfSurface {
  Surface surface;
  bool has_mask = false;  ///< its alpha, which is ignored, cuts out or fades parts
};

/// Returns the surface of a material; unpainted clay for index -1. Throws InputError if there is no
/// such material.
/// - The color is the base color factor, encoded for display like all scene colors. Textures are
///   not read: a texture counts as a mean gray, which the factor tints.
/// - Highlights and reflections: (1 - roughness) (0.2 + 0.6 metalness), with the exponent
///   2 / roughness^4 - 2 between 1 and 1000; the rest is diffuse. A texture halves both factors.
/// - Transparency: KHR_materials_transmission, or with alphaMode BLEND 1 - alpha; that
///   share is taken from the diffuse part. It refracts only with KHR_materials_volume; otherwise
///   the surface is thin.
GltfSurface gltf_surface(const tinygltf::Model& model, int material);

}  // namespace beambench::scenes::mesh
