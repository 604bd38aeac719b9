#include "harness/verify/selftest/kit.hpp"

#include <algorithm>
#include <array>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/rays/ray_file.hpp"
#include "harness/verify/selftest/kit_scenes.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/formats/mesh/obj_writer.hpp"
#include "scenes/formats/nff/nff_writer.hpp"

namespace beambench::verify {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIndex = "kit.json";
constexpr std::string_view kReadme =
    R"(# A kit of awkward scenes
Each folder has a scene and rays that are hard to trace correctly. `scene.nff` has all primitives.
`scene.obj`, if it exists, has the same surfaces as triangles: the face on the n-th line that begins
with f, counted from 0, is triangle n. For each ray of `closest.rays`, find the
closest hit in the closed interval from t_min to t_max; for each ray of `any.rays`, find whether there
is a hit. `rays.csv` has the same rays.

Write `closest.hits` or `closest-hits.csv`, and `any.hits` or `any-hits.csv`, beside the rays, then run

    beambench verify --kit FOLDER

or let beambench run your tracer on each case:

    beambench verify --kit FOLDER --command 'my-tracer {obj} {rays} {hits}'

A tracer that does not support a query, or rays with an interval, should end with exit code 77; the
table then has `unsupported`. `kit.json` names the family of each case and the tolerance that a library
with float arithmetic can be expected to keep: K u is 16 units in the last place of a float as large as
the coordinates. The formats are described in harness/verify/README.md of beambench.
)";

std::string folder_name(std::size_t number, std::string name) {
  std::ranges::replace(name, ' ', '-');
  return fmt::format("{:03}-{}", number, name);
}

void write_scene(const fs::path& folder, SceneWithRays made, const KitScene& of) {
  fs::create_directory(folder);
  const scenes::Scene& scene = made.scene;
  write_file(folder / "scene.nff",
             [&](std::ostream& file) { scenes::nff::write_nff(scene, file); });
  if (scene.spheres.empty() && scene.cones.empty()) {
    write_file(folder / "scene.obj",
               [&](std::ostream& file) { scenes::mesh::write_obj(scene, file); });
  }
  rays::RaySet set;
  set.rays = std::move(made.rays);
  set.scene_hash = scenes::scene_hash(scene);
  set.may_graze = true;
  set.must_hit = of.closed;
  rays::write_ray_file(folder / "rays.csv", set, {});
  for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
    set.query = query;
    rays::write_ray_file(folder / fmt::format("{}.rays", rays::to_string(query)), set,
                         {{"scene", scene.name}, {"family", of.family}});
  }
}

void make_empty_folder(const fs::path& folder) {
  make_folder(folder);
  if (!fs::is_empty(folder)) {
    throw InputError(fmt::format(
        "the folder '{}' is not empty; choose an empty folder or a new one", folder.string()));
  }
}

}  // namespace

std::size_t kit_size(const SelftestEffort& effort, PrimitiveKinds kinds) {
  std::size_t count = 0;
  for_each_kit_scene(effort, kinds, [&](const KitScene&) { ++count; });
  return count;
}

std::size_t write_kit(const fs::path& folder, const SelftestEffort& effort, PrimitiveKinds kinds,
                      base::Progress& progress) {
  make_empty_folder(folder);
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for_each_kit_scene(effort, kinds, [&](KitScene each) {
    SceneWithRays& made = each.made;
    const bool interval = each.family == kIntervalFamily;
    const std::string name =
        folder_name(cases.size(), made.scene.name + (interval ? " interval" : ""));
    progress.start(name);
    cases.push_back({{"folder", name},
                     {"family", each.family},
                     {"tolerance", each.tolerance},
                     {"closed", each.closed},
                     {"scene", made.scene.name},
                     {"spheres", made.scene.spheres.size()},
                     {"cones", made.scene.cones.size()},
                     {"polygons", made.scene.polygons.size()},
                     {"triangles", made.scene.triangles.size()}});
    write_scene(folder / name, std::move(made), each);
    progress.finish("written");
  });
  write_file(folder / "README.md", kReadme);
  const nlohmann::ordered_json index{{"seed", effort.seed}, {"cases", cases}};
  write_file(folder / kIndex, json_text(index) + '\n');  // last: a kit with this file is complete
  return cases.size();
}

std::vector<KitCase> read_kit(const fs::path& folder) {
  const fs::path file = folder / kIndex;
  const auto fail = [&](const std::string& problem) {
    throw InputError(fmt::format("{}: {}; 'beambench selftest --export DIR' writes a kit",
                                 file.string(), problem));
  };
  if (!fs::exists(file)) fail("there is no such file, so the folder does not contain a kit");
  const auto json = read_json_file<nlohmann::ordered_json>(file);
  if (!json.is_object() || !json.contains("cases") || !json["cases"].is_array()) {
    fail("it is not a list of cases");
  }
  std::vector<KitCase> cases;
  for (const auto& each : json["cases"]) {
    const bool named = each.is_object() && each.contains("folder") && each["folder"].is_string();
    if (!named) fail(fmt::format("case {} names no folder", cases.size() / 2));
    const std::string name = each["folder"].get<std::string>();
    if (name.find('/') != std::string::npos || name.starts_with('.')) {
      fail(fmt::format("'{}' is not a folder of the kit", name));
    }
    for (const std::string_view query : {"closest", "any"}) {
      KitCase found{.name = fmt::format("{}, {}", name, query),
                    .scene = folder / name / "scene.nff",
                    .rays = folder / name / fmt::format("{}.rays", query),
                    .hits = folder / name / fmt::format("{}.hits", query),
                    .family = each.value("family", name),
                    .query = query == "any" ? rays::Query::kAnyHit : rays::Query::kClosestHit,
                    .closed = each.value("closed", false)};
      const fs::path csv = folder / name / fmt::format("{}-hits.csv", query);
      if (!fs::exists(found.hits) && fs::exists(csv)) found.hits = csv;
      cases.push_back(std::move(found));
    }
  }
  return cases;
}

}  // namespace beambench::verify
