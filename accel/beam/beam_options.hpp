#pragma once
// Options of the beam tracer.

#include <cstdint>
#include <vector>

#include "accel/octree/octree.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::beam {

/// The treatment of a beam's samples, whatever cells the beam passes through.
struct BeamRules {
  std::int64_t handover = 0;       ///< beams with fewer samples become individual rays
  bool share_corners = false;      ///< samples in the corners of pixels are shared between pixels
  bool continue_with_rays = true;  ///< behind an occupied leaf: rays (thesis), or the beam again

  /// The parameters `handover`, `continue` and `share_corners`, and reading their values.
  static std::vector<ParameterInfo> parameters(const BeamRules& defaults);
  static BeamRules from(const Parameters& parameters);
};

struct BeamOptions : BeamRules {
  octree::OctreeOptions octree;

  static std::vector<ParameterInfo> parameters();
  static BeamOptions from(const Parameters& parameters);
};

}  // namespace beambench::accel::beam
