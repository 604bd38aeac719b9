#pragma once
// What a primitive's surface is made of.

#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

namespace beambench::scenes {

/// The surfaces and textures that the thesis adds to NFF (annex A, "Extensiones"). `kPlain` is
/// everything that NFF's `f` can say by itself.
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

/// NFF's `f`: color, diffuse and specular factors, Phong exponent, transmittance, index; and a
/// finish. Code that draws no textures uses the numbers alone.
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

/// The NFF word of a finish: `surfglass`, `texredmarble`...; `f` of a plain one.
std::string_view finish_word(Finish finish);

/// The finish that an NFF word of the thesis names; none for any other word, `f` included.
std::optional<Finish> find_finish(std::string_view word);

/// The surface that a finish's word stands for. The thesis gives no numbers: a texture has its mean
/// color, a mirror reflects nearly all, glass transmits nearly all. Plain is white and matte.
Surface finished_surface(Finish finish);

}  // namespace beambench::scenes
