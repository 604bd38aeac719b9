#pragma once
// What several commands ask for: a scene, one of its cameras, structures to put over it.

#include <string>
#include <string_view>
#include <vector>

#include "accel/registry.hpp"
#include "scenes/nff_reader.hpp"
#include "scenes/scene.hpp"

namespace beambench {

/// Loads a scene; what its file's reader noticed goes to stderr, or where the options are strict,
/// is refused. Throws as load_scene.
Scene open_scene(std::string_view spec, NffOptions options = {});

/// The camera of that name, the first where the name is empty. Throws InputError listing the names.
const Camera& choose_camera(const Scene& scene, std::string_view name);

/// The structures of a list as typed after --accel. Where `all` brought in `exhaustive` and the
/// scene is too large for it (kExhaustiveLimit), it is left out and `note` says so.
struct Contenders {
  std::vector<StructureChoice> choices;
  std::string note;
};
Contenders choose_contenders(std::string_view list, const Scene& scene);
inline constexpr std::size_t kExhaustiveLimit = 20000;

/// A structure as short as it can be told: its name and the parameters that are not at their
/// defaults.
std::string short_label(const StructureChoice& choice);

}  // namespace beambench
