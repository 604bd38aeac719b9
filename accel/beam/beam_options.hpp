#pragma once
// Options of the beam tracer.

#include <cstdint>
#include <string>
#include <vector>

#include "accel/beam/primitive_image.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::beam {

/// The method of testing samples in an occupied leaf; the hits are the same.
enum class LeafTest : std::uint8_t {
  kSimd,    ///< against the images of primitives, a register of samples at a time
  kScalar,  ///< against the images, one sample at a time
  kExact    ///< by the canonical test only, as in structures that trace single rays; no images
};

/// Returns the kernels that test images; null if the test uses no images.
const ProbeKernels* kernels_of(LeafTest leaf);
/// Returns Highway's name of the instruction set that leaves are tested with; empty without SIMD
/// (`Statistics::instruction_set`).
std::string instruction_set_of(LeafTest leaf);

/// The rules for a beam's samples, whatever cells the beam passes through.
struct BeamRules {
  std::int64_t handover = 0;       ///< beams with fewer samples become individual rays
  bool share_corners = false;      ///< samples in the corners of pixels are shared between pixels
  bool continue_with_rays = true;  ///< behind an occupied leaf: rays (thesis), or the beam again
  LeafTest leaf = LeafTest::kSimd;

  /// Returns the parameters `handover`, `continue`, `share_corners` and `leaf`.
  static std::vector<ParameterInfo> parameters(const BeamRules& defaults);
  static BeamRules from(const Parameters& parameters);
};

struct BeamOptions : BeamRules {
  octree::OctreeOptions octree;

  static std::vector<ParameterInfo> parameters();
  static BeamOptions from(const Parameters& parameters);
};

}  // namespace beambench::accel::beam
