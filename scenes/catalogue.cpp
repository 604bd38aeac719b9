#include "scenes/catalogue.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"
#include "scenes/core/nearest_name.hpp"
#include "scenes/extend_catalogue.hpp"
#include "scenes/formats/mesh/mesh_format.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "scenes/generators/other/bumpy.hpp"
#include "scenes/generators/other/soup.hpp"
#include "scenes/generators/other/tessellated_balls.hpp"
#include "scenes/generators/spd/balls.hpp"
#include "scenes/generators/spd/gears.hpp"
#include "scenes/generators/spd/jacks.hpp"
#include "scenes/generators/spd/lattice.hpp"
#include "scenes/generators/spd/mount.hpp"
#include "scenes/generators/spd/rings.hpp"
#include "scenes/generators/spd/shells.hpp"
#include "scenes/generators/spd/sombrero.hpp"
#include "scenes/generators/spd/teapot.hpp"
#include "scenes/generators/spd/tetra.hpp"
#include "scenes/generators/spd/tree.hpp"
#include "scenes/generators/thesis/ajedrez.hpp"
#include "scenes/generators/thesis/bola_espacial.hpp"
#include "scenes/generators/thesis/caracol.hpp"
#include "scenes/generators/thesis/casa_de_campo.hpp"
#include "scenes/generators/thesis/closed_room.hpp"
#include "scenes/generators/thesis/delfines.hpp"
#include "scenes/generators/thesis/escena1.hpp"
#include "scenes/generators/thesis/escena2.hpp"
#include "scenes/generators/thesis/finishes.hpp"
#include "scenes/generators/thesis/flamenco.hpp"
#include "scenes/generators/thesis/gato_bill.hpp"
#include "scenes/generators/thesis/habitacion.hpp"
#include "scenes/generators/thesis/maceta.hpp"
#include "scenes/generators/thesis/misil.hpp"
#include "scenes/generators/thesis/tetera.hpp"
#include "scenes/generators/thesis/torre_eiffel.hpp"

namespace beambench::scenes {
namespace {

std::vector<SceneInfo> built_in_scenes() {
  return {generators::ajedrez_scene(),
          generators::balls_scene(),
          generators::bola_espacial_scene(),
          generators::bumpy_scene(),
          generators::caracol_scene(),
          generators::casa_de_campo_scene(),
          generators::closed_room_scene(),
          generators::delfines_scene(),
          generators::escena1_scene(),
          generators::escena2_scene(),
          generators::finishes_scene(),
          generators::flamenco_scene(),
          generators::gato_bill_scene(),
          generators::gears_scene(),
          generators::habitacion_scene(),
          generators::jacks_scene(),
          generators::lattice_scene(),
          generators::maceta_scene(),
          generators::misil_scene(),
          generators::mount_scene(),
          generators::rings_scene(),
          generators::shells_scene(),
          generators::sombrero_scene(),
          generators::soup_scene(),
          generators::stetra_scene(),
          generators::teapot_scene(),
          generators::tessellated_balls_scene(),
          generators::tetera_scene(),
          generators::tetra_scene(),
          generators::torre_eiffel_scene(),
          generators::tree_scene()};
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
         !mesh::mesh_ending(spec).empty() || find_reader(spec) != nullptr;
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

Scene load_scene(std::string_view spec, std::vector<std::string>* warnings,
                 nff::NffOptions options) {
  if (spec.starts_with(mesh::kMeshPrefix)) {
    const mesh::RegisteredMesh mesh =
        mesh::find_registered_mesh(spec.substr(mesh::kMeshPrefix.size()));
    return mesh::load_mesh({mesh.path, std::string(spec), mesh.orientation, options.strict},
                           warnings);
  }
  if (is_path(spec)) {
    if (const std::string ending = mesh::mesh_ending(spec); !ending.empty()) {
      return mesh::load_mesh(
          {spec, std::string(spec), mesh::usual_orientation(ending), options.strict}, warnings);
    }
    if (const SceneReader* reader = find_reader(spec)) {
      return read_by_plugin(*reader, spec, warnings, options.strict);
    }
    mesh::refuse_foreign_format(spec);
    nff::NffResult result = nff::read_nff(spec, options);
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

}  // namespace beambench::scenes
