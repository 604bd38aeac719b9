#include "harness/bench/plan.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

#include <fmt/format.h>

#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::bench {
namespace {

std::shared_ptr<const scenes::Scene> load(const SceneEntry& entry) {
  try {
    std::vector<std::string> warnings;
    auto scene = std::make_shared<const scenes::Scene>(scenes::load_scene(entry.spec, &warnings));
    for (const std::string& warning : warnings) fmt::print(stderr, "beambench: {}\n", warning);
    return scene;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", entry.place, error.what()));
  }
}

scenes::Camera camera_of(const scenes::Scene& scene, const std::string& name,
                         const SceneEntry& entry) {
  try {
    return scenes::find_camera(scene, name);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", entry.place, error.what()));
  }
}

std::vector<scenes::Camera> cameras_of(const scenes::Scene& scene, const SceneEntry& entry) {
  if (entry.cameras.empty()) return {scene.cameras.front()};
  std::vector<scenes::Camera> cameras;
  for (const std::string& name : entry.cameras) {
    cameras.push_back(camera_of(scene, name, entry));
  }
  return cameras;
}

std::uint64_t ray_count(const CellGroup& group) {
  return static_cast<std::uint64_t>(group.resolution.width) *
         static_cast<std::uint64_t>(group.resolution.height) *
         static_cast<std::uint64_t>(group.samples);
}

bool applies(const Exclusion& rule, const CellGroup& group, const SceneEntry& entry,
             const accel::StructureChoice& structure) {
  if (rule.structure && *rule.structure != structure.info().name) return false;
  if (rule.scene && *rule.scene != entry.spec && *rule.scene != group.scene->name) return false;
  if (rule.primitives_above && group.scene->primitives.size() <= *rule.primitives_above) {
    return false;
  }
  return !rule.rays_above || ray_count(group) > *rule.rays_above;
}

/// Makes the groups and cells of a plan, each cell once.
class Planner {
 public:
  explicit Planner(const SweepConfig& config) : config_(config) {}

  Plan make() && {
    for (const SceneEntry& entry : config_.scenes) add_scene(entry);
    return std::move(plan_);
  }

 private:
  void add_scene(const SceneEntry& entry) {
    const std::shared_ptr<const scenes::Scene> scene = load(entry);
    for (const scenes::Camera& camera : cameras_of(*scene, entry)) {
      for (const rays::Resolution& resolution : config_.resolutions) {
        for (const int samples : config_.samples) {
          for (const rays::RayChoice& rays : config_.rays) {
            if (!rays.file.empty() && !is_first(*scene, camera, resolution, samples)) continue;
            add_group({scene, camera, resolution, samples, rays, config_.threads, {}}, entry);
          }
        }
      }
    }
  }

  /// The rays of a file are the same in every view: they are asked once.
  bool is_first(const scenes::Scene& scene, const scenes::Camera& camera,
                const rays::Resolution& resolution, int samples) const {
    return camera.name == scene.cameras.front().name && resolution == config_.resolutions.front() &&
           samples == config_.samples.front();
  }

  void add_group(CellGroup group, const SceneEntry& entry) {
    for (const accel::StructureChoice& structure : config_.structures) {
      const auto excluded = [&](const Exclusion& rule) {
        return applies(rule, group, entry, structure);
      };
      if (std::any_of(config_.exclude.begin(), config_.exclude.end(), excluded)) continue;
      CellId id{group.scene->name,     group.camera.name,
                structure.info().name, structure.parameters().canonical(),
                group.resolution,      group.samples,
                group.rays.label};
      if (names_.insert(id.name()).second) {
        group.cells.push_back({names_.size() - 1, std::move(id), structure});
      } else {
        ++plan_.merged;
      }
    }
    if (!group.cells.empty()) plan_.groups.push_back(std::move(group));
  }

  const SweepConfig& config_;
  Plan plan_;
  std::set<std::string> names_;
};

/// The entry of that name among structures or scenes; nullptr for a stranger, such as a file.
template <class Infos>
const auto* find_info(const Infos& infos, const std::string& name) {
  const auto found =
      std::ranges::find_if(infos, [&](const auto& info) { return info.name == name; });
  return found == infos.end() ? nullptr : &*found;
}

/// `label` is a name with all parameters.
template <class Infos>
std::string shortened(const Infos& infos, const std::string& label) {
  const std::string name = label.substr(0, label.find(':'));
  const auto* info = find_info(infos, name);
  if (info == nullptr || name.size() == label.size()) return label;
  return Parameters(name, info->parameters, parse_spec(label).parameters).short_label();
}

}  // namespace

std::string CellGroup::name() const {
  return fmt::format("{}/{}/{}/{}/{}", scene->name, camera.name, rays::to_string(resolution),
                     samples, rays.label);
}

std::size_t Plan::cell_count() const {
  std::size_t count = 0;
  for (const CellGroup& group : groups) count += group.cells.size();
  return count;
}

Plan make_plan(const SweepConfig& config) {
  Plan plan = Planner(config).make();
  if (plan.groups.empty()) {
    throw InputError("nothing is left to measure: 'exclude' leaves out every cell; relax it");
  }
  return plan;
}

std::vector<SceneFacts> scene_facts(const Plan& plan) {
  std::vector<SceneFacts> facts;
  for (const CellGroup& group : plan.groups) {
    const scenes::Scene& scene = *group.scene;
    if (!facts.empty() && facts.back().name == scene.name) continue;  // groups go scene by scene
    facts.push_back({scene.name, scenes::scene_hash(scene), scene.primitives.size()});
  }
  return facts;
}

std::string shown_scene(const std::string& scene) {
  return shortened(scenes::scene_catalogue(), scene);
}

std::string shown_name(const CellId& id) {
  CellId shown = id;
  shown.scene = shown_scene(id.scene);
  shown.parameters.clear();
  const std::string colon = id.parameters.empty() ? "" : ":";
  shown.structure = shortened(accel::registry().structures(), id.structure + colon + id.parameters);
  return shown.name();
}

}  // namespace beambench::bench
