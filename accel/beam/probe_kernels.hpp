#pragma once
// Testing many samples against one primitive's image, compiled for several instruction sets.

#include <span>

#include "accel/beam/primitive_image.hpp"

namespace beambench::accel::beam {

/// The probes for one instruction set. They may only reject: what they let pass is confirmed by the
/// canonical test.
struct ProbeKernels {
  /// May the samples hit one of a polygon's triangles?
  SampleMask (*triangles)(std::span<const TriangleImage>, const SampleBatch&);
  SampleMask (*sphere)(const SphereImage&, const SampleBatch&);
};

/// Those for the best instruction set of this machine that Highway supports.
const ProbeKernels& best_probe_kernels();

}  // namespace beambench::accel::beam
