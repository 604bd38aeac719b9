#include "accel/grid_beam/grid_beam_options.hpp"

#include <cstdint>
#include <utility>

namespace beambench::accel::grid_beam {

namespace {

/// The default of `handover`. Beams are divided at every voxel, so small beams cost more than their
/// rays. Of 16, 48, 128 and 1000, 128 was the smallest value at which none of four scenes (escena2,
/// gato-bill, torre-eiffel, habitacion; 640x480) took longer than with single rays through the same
/// grids. The default is twice that, as a margin for other scenes.
constexpr std::int64_t kHandover = 256;

}  // namespace

std::vector<ParameterInfo> GridBeamOptions::parameters() {
  std::vector<ParameterInfo> parameters;
  for (ParameterInfo& parameter : hierarchical_grid::HierarchicalGridOptions::parameters()) {
    if (parameter.name == "inner" || parameter.name == "mailboxes") continue;
    parameters.push_back(std::move(parameter));
  }
  beam::BeamRules defaults;
  defaults.handover = kHandover;
  for (ParameterInfo& rule : beam::BeamRules::parameters(defaults)) {
    parameters.push_back(std::move(rule));
  }
  return parameters;
}

GridBeamOptions GridBeamOptions::from(const Parameters& parameters) {
  using hierarchical_grid::HierarchicalGridOptions;
  GridBeamOptions options{beam::BeamRules::from(parameters),
                          HierarchicalGridOptions::hierarchy_from(parameters)};
  options.grid.inner = HierarchicalGridOptions::Inner::kPowers;
  return options;
}

}  // namespace beambench::accel::grid_beam
