#include "scenes/catalogue.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/error.hpp"
#include "scenes/extend_catalogue.hpp"
#include "scenes/generators/ajedrez.hpp"
#include "scenes/generators/balls.hpp"
#include "scenes/generators/bola_espacial.hpp"
#include "scenes/generators/bumpy.hpp"
#include "scenes/generators/caracol.hpp"
#include "scenes/generators/casa_de_campo.hpp"
#include "scenes/generators/closed_room.hpp"
#include "scenes/generators/delfines.hpp"
#include "scenes/generators/escena1.hpp"
#include "scenes/generators/escena2.hpp"
#include "scenes/generators/finishes.hpp"
#include "scenes/generators/flamenco.hpp"
#include "scenes/generators/gato_bill.hpp"
#include "scenes/generators/gears.hpp"
#include "scenes/generators/habitacion.hpp"
#include "scenes/generators/jacks.hpp"
#include "scenes/generators/lattice.hpp"
#include "scenes/generators/maceta.hpp"
#include "scenes/generators/misil.hpp"
#include "scenes/generators/mount.hpp"
#include "scenes/generators/rings.hpp"
#include "scenes/generators/shells.hpp"
#include "scenes/generators/sombrero.hpp"
#include "scenes/generators/soup.hpp"
#include "scenes/generators/teapot.hpp"
#include "scenes/generators/tessellated_balls.hpp"
#include "scenes/generators/tetera.hpp"
#include "scenes/generators/tetra.hpp"
#include "scenes/generators/torre_eiffel.hpp"
#include "scenes/generators/tree.hpp"
#include "scenes/meshes/mesh_format.hpp"
#include "scenes/meshes/mesh_registry.hpp"
#include "scenes/meshes/mesh_scene.hpp"
#include "scenes/nearest_name.hpp"

namespace beambench {
namespace {

std::vector<SceneInfo> built_in_scenes() {
  return {ajedrez_scene(),     balls_scene(),    bola_espacial_scene(),
          bumpy_scene(),       caracol_scene(),  casa_de_campo_scene(),
          closed_room_scene(), delfines_scene(), escena1_scene(),
          escena2_scene(),     finishes_scene(), flamenco_scene(),
          gato_bill_scene(),   gears_scene(),    habitacion_scene(),
          jacks_scene(),       lattice_scene(),  maceta_scene(),
          misil_scene(),       mount_scene(),    rings_scene(),
          shells_scene(),      sombrero_scene(), soup_scene(),
          stetra_scene(),      teapot_scene(),   tessellated_balls_scene(),
          tetera_scene(),      tetra_scene(),    torre_eiffel_scene(),
          tree_scene()};
}

/// What the program knows: its own scenes, and what plug-ins add.
struct Catalogue {
  std::vector<SceneInfo> scenes;
  std::vector<SceneReader> readers;
};

Catalogue& whole_catalogue() {
  static Catalogue all{built_in_scenes(), {}};
  return all;
}

/// The reader of a plug-in for that file; nullptr where there is none.
const SceneReader* find_reader(std::string_view file_name) {
  std::string name(file_name);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto readers = scene_readers();
  const auto found = std::ranges::find_if(
      readers, [&](const SceneReader& reader) { return name.ends_with(reader.ending); });
  return found == readers.end() ? nullptr : &*found;
}

Scene read_by_plugin(const SceneReader& reader, std::string_view spec,
                     std::vector<std::string>* warnings, bool strict) {
  std::vector<std::string> noticed;
  Scene scene = reader.read(std::filesystem::path(spec), noticed);
  scene.name = spec;
  if (strict && !noticed.empty()) throw InputError(noticed.front());
  if (warnings != nullptr) warnings->insert(warnings->end(), noticed.begin(), noticed.end());
  return scene;
}

bool is_path(std::string_view spec) {
  return spec.find('/') != std::string_view::npos || spec.ends_with(".nff") ||
         !mesh_ending(spec).empty() || find_reader(spec) != nullptr;
}

[[noreturn]] void refuse_name(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneInfo& info : scene_catalogue()) names.push_back(info.name);
  throw InputError(fmt::format(
      "there is no scene '{}'; {}the scenes are {}; a file is given as a path with a slash or the "
      "ending .nff or of a mesh, an installed mesh as mesh:NAME, and a scene of a plug-in is known "
      "after --plugin FILE",
      name, did_you_mean(name, names), fmt::join(names, ", ")));
}

}  // namespace

std::span<const SceneInfo> scene_catalogue() { return whole_catalogue().scenes; }

std::span<const SceneReader> scene_readers() { return whole_catalogue().readers; }

void extend_catalogue(std::vector<SceneInfo> scenes, std::vector<SceneReader> readers) {
  Catalogue& all = whole_catalogue();
  std::ranges::move(scenes, std::back_inserter(all.scenes));
  std::ranges::sort(all.scenes, {}, &SceneInfo::name);
  std::ranges::move(readers, std::back_inserter(all.readers));
}

const SceneInfo& find_scene(const std::string& name) {
  const auto catalogue = scene_catalogue();
  const auto info = std::find_if(catalogue.begin(), catalogue.end(),
                                 [&](const SceneInfo& i) { return i.name == name; });
  if (info == catalogue.end()) refuse_name(name);
  return *info;
}

Scene load_scene(std::string_view spec, std::vector<std::string>* warnings, NffOptions options) {
  if (spec.starts_with(kMeshPrefix)) {
    const RegisteredMesh mesh = find_registered_mesh(spec.substr(kMeshPrefix.size()));
    return load_mesh({mesh.path, std::string(spec), mesh.orientation, options.strict}, warnings);
  }
  if (is_path(spec)) {
    if (const std::string ending = mesh_ending(spec); !ending.empty()) {
      return load_mesh({spec, std::string(spec), usual_orientation(ending), options.strict},
                       warnings);
    }
    if (const SceneReader* reader = find_reader(spec)) {
      return read_by_plugin(*reader, spec, warnings, options.strict);
    }
    refuse_foreign_format(spec);
    NffResult result = read_nff(spec, options);
    if (warnings != nullptr) {
      warnings->insert(warnings->end(), result.warnings.begin(), result.warnings.end());
    }
    return std::move(result.scene);
  }

  const Spec parsed = parse_spec(spec);
  const SceneInfo& info = find_scene(parsed.name);
  const Parameters parameters(info.name, info.parameters, parsed.parameters);
  Scene scene = info.generate(parameters);
  parameters.require_given_were_read();
  if (!info.origin.empty()) scene.name = parameters.label();  // records and replays rely on it
  return scene;
}

}  // namespace beambench
