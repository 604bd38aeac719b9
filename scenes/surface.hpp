#pragma once
// The material of a primitive's surface.

#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

namespace beambench::scenes {

/// The surfaces and textures that the thesis adds to NFF (annex A, "Extensiones"). `kPlain` is any
/// surface that NFF's `f` alone can express.
enum class Finish : std::uint8_t {
  kPlain,
  kReflect,
  kGlass,
  kGranite,
  kShiny,
  kBlackMarble,
  kBlueMarble,
  kCherryWood,
  kClouds,
  kDarkWood,
  kPineWood,
  kRedMarble,
  kWhiteMarble,
};

/// NFF's `f` (color, diffuse and specular factors, Phong exponent, transmittance, index) and a
/// finish. Code that does not draw textures uses only the numbers.
struct Surface {
  glm::vec3 color{1.0F};
  float diffuse = 1.0F;
  float specular = 0.0F;
  float shine = 0.0F;
  float transmittance = 0.0F;
  float refraction_index = 1.0F;
  Finish finish = Finish::kPlain;

  bool operator==(const Surface&) const = default;
};

/// Returns the NFF word of a finish, such as `surfglass` or `texredmarble`, or `f` for a plain one.
std::string_view finish_word(Finish finish);

/// Returns the finish that an NFF word of the thesis names, or nothing for any other word,
/// including `f`.
std::optional<Finish> find_finish(std::string_view word);

/// Returns the surface of a finish. The thesis states no numbers. A texture has its mean color, a
/// mirror reflects nearly all light, and glass transmits nearly all of it. The plain surface is
/// white and matte.
Surface finished_surface(Finish finish);

}  // namespace beambench::scenes
