#pragma once
// The plan of a sweep: its cells, in groups that share their rays.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "harness/measure/config.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/scene.hpp"

namespace beambench::measure {

/// One cell to measure.
struct PlannedCell {
  std::size_t index;  ///< index in the whole plan: the order of the record's rows
  CellId id;
  accel::StructureChoice structure;
  rays::RayChoice rays;  ///< the rays of its view, in one of their orders
  /// The number of parameter sets of its contender if the contender is tuned with these rays;
  /// otherwise 1.
  int parameter_sets = 1;
};

/// Cells with the same scene and the same rays, in any order of the rays: contenders measured in
/// turns.
struct CellGroup {
  std::shared_ptr<const scenes::Scene> scene;  ///< freed when the last of its groups is done
  std::uint64_t scene_hash;
  scenes::Camera camera;
  rays::Resolution resolution;
  int samples;
  rays::RayChoice rays;  ///< in the order of generation
  int threads = 1;       ///< number of threads that trace an image
  std::vector<PlannedCell> cells;
  std::string spec{};  ///< the scene as spelled in the configuration

  /// Returns `escena1/default/320x200/1/primary`.
  std::string name() const;
  /// Returns the name without those parameters of the scene that have their default values.
  std::string shown_name() const;
  rays::ImageOfRays image() const { return {camera, resolution, samples}; }
};

/// Returns the identity of a structure's cell in a view, with its rays in some order.
CellId id_of(const CellGroup& view, const accel::StructureChoice& structure,
             const rays::RayChoice& rays);

struct Plan {
  std::vector<CellGroup> groups;
  std::size_t merged = 0;  ///< number of duplicate cells, which are measured once

  std::size_t cell_count() const;
};

/// Loads every scene once and forms all combinations of the configuration: scene by scene, all
/// structures of a group together. Duplicate cells are measured once. Throws InputError if a scene
/// cannot be loaded or has no camera of that name, or if nothing is left to measure.
Plan make_plan(const SweepConfig& config);

/// Returns the facts of the scenes in the plan, each once.
std::vector<SceneFacts> scene_facts(const Plan& plan);

/// Removes the cells that `keep` rejects, and groups without cells.
template <class Keep>
void filter_cells(Plan& plan, Keep keep) {
  for (CellGroup& group : plan.groups) {
    std::erase_if(group.cells, [&](const PlannedCell& cell) { return !keep(cell); });
  }
  std::erase_if(plan.groups, [](const CellGroup& group) { return group.cells.empty(); });
}

/// Returns `CellId::name` without those parameters of the scene and the structure that have their
/// default values, to keep lines short: `escena1/default/320x200/1/primary/samet:max_level=6`.
std::string shown_name(const CellId& id);

/// Returns the structure's part of that name: `samet:max_level=6`.
std::string shown_structure(const CellId& id);

/// Returns a scene's name without parameters that have their default values: `tetra:n=4`, or
/// `tetra` for `tetra:n=6`. Leaves paths unchanged.
std::string shown_scene(const std::string& scene);

}  // namespace beambench::measure
