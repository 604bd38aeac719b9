#pragma once
// The names of a run's contenders and views, which state what differs between its cells.

#include <span>
#include <string>
#include <vector>

namespace beambench::analysis {

/// The facts about a cell that a name may have to state.
struct NamedCell {
  std::string scene;
  std::string camera;
  std::string structure;
  std::string parameters;
  int samples;
  std::string ray_kind;  ///< including its order
  std::string machine_id;
  int parameter_sets;  ///< number of sets tried for the contender; 1 without tuning
};

/// The names of a cell among the cells of its run.
struct Names {
  /// The structure and the parameters in which its variants differ. Also states `robust=false` and
  /// `backface_culling=true`, which change hits, and the order of the rays if it varies. If tuned:
  /// `embree (best of 8)`.
  std::string contender;
  std::string subject;  ///< the scene; also the camera, samples and ray kind if they vary
  std::string view;     ///< the subject with the machine: the unit of comparison
};

/// Returns the names of all cells, in order.
std::vector<Names> name_cells(std::span<const NamedCell> cells);

}  // namespace beambench::analysis
