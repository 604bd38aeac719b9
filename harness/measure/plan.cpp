#include "harness/measure/plan.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "accel/core/registry.hpp"
#include "harness/base/messages.hpp"
#include "scenes/animation.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"

namespace beambench::measure {
namespace {

/// Runs `work`; if it throws an InputError, adds the entry's place at the beginning of its message.
template <class Work>
auto placed(const SceneEntry& entry, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", entry.place, error.what()));
  }
}

std::shared_ptr<const scenes::Scene> load(const SceneEntry& entry) {
  return placed(
      entry, [&] { return std::make_shared<const scenes::Scene>(base::open_scene(entry.spec)); });
}

std::vector<scenes::Camera> cameras_of(const scenes::Scene& scene, const SceneEntry& entry) {
  if (entry.cameras.empty()) return {scene.cameras.front()};
  std::vector<scenes::Camera> cameras;
  for (const std::string& name : entry.cameras) {
    cameras.push_back(placed(entry, [&] { return scenes::find_camera(scene, name); }));
  }
  return cameras;
}

std::uint64_t ray_count(const CellGroup& group) {
  return static_cast<std::uint64_t>(group.resolution.width) *
         static_cast<std::uint64_t>(group.resolution.height) *
         static_cast<std::uint64_t>(group.samples);
}

bool applies(const Exclusion& rule, const CellGroup& group, const SceneEntry& entry,
             const accel::StructureChoice& structure, const rays::RayChoice& rays) {
  if (rule.is_sorted && *rule.is_sorted != rays.is_sorted) return false;
  if (rule.structure && *rule.structure != structure.info().name) return false;
  if (rule.scene && *rule.scene != entry.spec && *rule.scene != group.scene->name) return false;
  if (rule.primitives_above && group.scene->primitives.size() <= *rule.primitives_above) {
    return false;
  }
  return !rule.rays_above || ray_count(group) > *rule.rays_above;
}

/// Rays, in the orders in which they are traced.
using Orders = std::vector<rays::RayChoice>;

/// A group that is not yet in the plan.
struct NewGroup {
  CellGroup group;
  Orders orders;
};

/// Adds the group's cells, omitting those already in the plan; `names` are the names of the cells
/// in the plan.
void add_group(const SweepConfig& config, const SceneEntry& entry, NewGroup made, Plan& plan,
               std::set<std::string>& names) {
  CellGroup& group = made.group;
  for (const rays::RayChoice& rays : made.orders) {
    for (const SweptStructure& swept : config.structures) {
      for (const accel::StructureChoice& structure : swept.sets) {
        if (std::ranges::any_of(config.exclude, [&](const Exclusion& rule) {
              return applies(rule, group, entry, structure, rays);
            })) {
          continue;
        }
        CellId id = id_of(group, structure, rays);
        if (names.insert(id.name()).second) {
          group.cells.push_back({names.size() - 1, std::move(id), structure, rays,
                                 swept.is_tuned ? static_cast<int>(swept.sets.size()) : 1});
        } else {
          ++plan.merged;
        }
      }
    }
  }
  if (!group.cells.empty()) plan.groups.push_back(std::move(group));
}

/// Returns the rays of a sweep, grouping those that differ only in their order.
std::vector<Orders> by_kind(const std::vector<rays::RayChoice>& all) {
  const auto kind = [](const rays::RayChoice& rays) { return rays::divide_label(rays.label).rays; };
  std::vector<Orders> kinds;
  for (const rays::RayChoice& rays : all) {
    const auto same = std::ranges::find_if(
        kinds, [&](const Orders& orders) { return kind(orders.front()) == kind(rays); });
    (same == kinds.end() ? kinds.emplace_back() : *same).push_back(rays);
  }
  return kinds;
}

/// Returns the same rays in their order of generation.
rays::RayChoice unsorted(rays::RayChoice rays) {
  rays.is_sorted = false;
  rays.label = rays::divide_label(rays.label).rays;
  return rays;
}

/// Returns the groups of a scene in one view.
std::vector<NewGroup> groups_of(const SweepConfig& config, const std::string& spec,
                                const std::shared_ptr<const scenes::Scene>& scene,
                                std::uint64_t hash, const scenes::Camera& camera) {
  std::vector<NewGroup> groups;
  for (const rays::Resolution& resolution : config.resolutions) {
    for (const int samples : config.samples) {
      const bool first = camera.name == scene->cameras.front().name &&
                         resolution == config.resolutions.front() &&
                         samples == config.samples.front();
      for (Orders& orders : by_kind(config.rays)) {
        // The rays of a file are the same in every view, so they are traced once.
        if (!orders.front().file.empty() && !first) continue;
        groups.push_back({{scene,
                           hash,
                           camera,
                           resolution,
                           samples,
                           unsorted(orders.front()),
                           config.threads,
                           {},
                           spec},
                          std::move(orders)});
      }
    }
  }
  return groups;
}

/// Returns `label`, a structure or scene with all parameters, without parameters that have their
/// default values; anything not in `infos`, such as a file, stays as it is.
template <class Infos>
std::string shortened(const Infos& infos, const std::string& label) {
  const std::string name = label.substr(0, label.find(':'));
  const auto info = std::ranges::find_if(infos, [&](const auto& i) { return i.name == name; });
  if (info == infos.end() || name.size() == label.size()) return label;
  try {
    return Parameters(name, info->parameters, parse_spec(label).parameters).short_label();
  } catch (const InputError&) {
    return label;  // recorded by a version with other parameters
  }
}

}  // namespace

std::string CellGroup::name() const {
  return fmt::format("{}/{}/{}/{}/{}", scene->name, camera.name, rays::to_string(resolution),
                     samples, rays.label);
}

std::string CellGroup::shown_name() const {
  return name().replace(0, scene->name.size(), shown_scene(scene->name));
}

CellId id_of(const CellGroup& view, const accel::StructureChoice& structure,
             const rays::RayChoice& rays) {
  return {view.scene->name,
          view.camera.name,
          structure.info().name,
          structure.parameters().canonical(),
          view.resolution,
          view.samples,
          rays.label};
}

std::size_t Plan::cell_count() const {
  std::size_t count = 0;
  for (const CellGroup& group : groups) count += group.cells.size();
  return count;
}

Plan make_plan(const SweepConfig& config) {
  Plan plan;
  std::set<std::string> names;
  for (const SceneEntry& entry : config.scenes) {
    const std::shared_ptr<const scenes::Scene> scene = load(entry);
    const std::uint64_t hash = scenes::scene_hash(*scene);
    for (const scenes::Camera& camera : cameras_of(*scene, entry)) {
      for (NewGroup& group : groups_of(config, entry.spec, scene, hash, camera)) {
        add_group(config, entry, std::move(group), plan, names);
      }
    }
  }
  if (plan.groups.empty()) {
    throw InputError("nothing is left to measure: 'exclude' matches every cell; relax it");
  }
  return plan;
}

std::vector<SceneFacts> scene_facts(const Plan& plan) {
  std::vector<SceneFacts> facts;
  for (const CellGroup& group : plan.groups) {
    const scenes::Scene& scene = *group.scene;
    if (!facts.empty() && facts.back().name == scene.name) continue;  // groups are ordered by scene
    facts.push_back({scene.name, group.scene_hash, scene.primitives.size()});
  }
  return facts;
}

std::string shown_scene(const std::string& scene) {
  const scenes::FrameName name = scenes::divide_frame(scene);
  const std::string shown = shortened(scenes::scene_catalogue(), std::string(name.scene));
  return name.frame ? fmt::format("{}@{}", shown, *name.frame) : shown;
}

std::string shown_structure(const CellId& id) {
  const std::string colon = id.parameters.empty() ? "" : ":";
  return shortened(accel::registry().structures(), id.structure + colon + id.parameters);
}

std::string shown_name(const CellId& id) {
  CellId shown = id;
  shown.scene = shown_scene(id.scene);
  shown.structure = shown_structure(id);
  shown.parameters.clear();
  return shown.name();
}

}  // namespace beambench::measure
