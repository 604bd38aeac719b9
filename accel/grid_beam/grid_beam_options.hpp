#pragma once
// Options of beams through a hierarchy of grids.

#include <vector>

#include "accel/beam/beam_options.hpp"
#include "accel/hierarchical_grid/hierarchical_grid_options.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::grid_beam {

struct GridBeamOptions {
  beam::BeamRules rules;
  hierarchical_grid::HierarchicalGridOptions grid;

  /// Returns the parameters. The hierarchy is built with `Inner::kPowers`, and its rays use
  /// mailboxes.
  static std::vector<ParameterInfo> parameters();
  static GridBeamOptions from(const Parameters& parameters);
};

}  // namespace beambench::accel::grid_beam
