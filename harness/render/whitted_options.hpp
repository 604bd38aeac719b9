#pragma once
// How far a picture follows light.

#include <span>
#include <string_view>

#include "harness/rays/ray_kind.hpp"

namespace beambench::render {

/// How the visibility of a light is decided. All give the same picture, unless something opaque
/// lies no farther behind glass than rays begin beside surfaces (`lift_at`).
enum class ShadowMethod {
  kRays,        ///< one any-hit query a light
  kCache,       ///< first the opaque primitive that hid the light last (OORT; `ShadowCache`)
  kLightBuffer  ///< what each direction from the light holds is listed beforehand (`LightBuffer`)
};

/// The names after --shadows, in the order of `ShadowMethod`.
std::span<const std::string_view> shadow_method_names();
/// Throws InputError listing the valid names.
ShadowMethod parse_shadow_method(std::string_view name);

struct WhittedOptions {
  /// Maximum ray depth, the primary ray included: 5 in Haines's databases (SPD).
  int max_depth = 5;
  /// Adaptive depth control (Hall and Greenberg, "A testbed for realistic image synthesis", IEEE
  /// CG&A 3(8), 1983): a ray whose part in its pixel's color is less than this is not traced. 0
  /// traces all.
  double min_weight = 0.0;
  ShadowMethod shadows = ShadowMethod::kRays;
  /// Glass spawns a mirror ray even where its specular factor is 0, so that the picture takes
  /// nothing from it: rule 8 of Haines's databases (SPD), whose counts include these rays.
  bool glass_always_mirrors = false;
};

/// Of a whole picture as a kind of rays: `whitted:depth=3,shadows=cache`.
WhittedOptions whitted_options(const rays::RayChoice& choice);

}  // namespace beambench::render
