#pragma once
// The names of the contenders and the views of a run, by what differs between its cells.

#include <span>
#include <string>
#include <vector>

namespace beambench::analysis {

/// The facts that a name may have to state about a cell.
struct NamedCell {
  std::string scene;
  std::string camera;
  std::string structure;
  std::string parameters;
  int samples;
  std::string ray_kind;  ///< with its order
  std::string machine_id;
  int parameter_sets;  ///< tried for its contender; 1 where it is not tuned
};

/// The names of a cell among others.
struct Names {
  /// The structure, with the parameters by which its variants differ, `robust=false` and
  /// `backface_culling=true`, which change hits, and the order of the rays where that varies;
  /// tuned, `embree (best of 8)`.
  std::string contender;
  std::string subject;  ///< the scene, with camera, samples and kind of rays where it varies
  std::string view;     ///< the same with the machine: what is compared
};

/// Returns the names of each cell.
std::vector<Names> name_cells(std::span<const NamedCell> cells);

}  // namespace beambench::analysis
