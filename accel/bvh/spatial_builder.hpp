#pragma once
// Builds a binary hierarchy whose splits may divide primitives.

#include <span>

#include "accel/bvh/bvh_builder.hpp"
#include "accel/bvh/primitive_part.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// Builds by the method of Stich, Friedrich and Dietrich ("Spatial Splits in Bounding Volume
/// Hierarchies", 2009): if the children of the best division by centers (that of `build_bvh`)
/// overlap by more than 1e-5 of the root's surface (section 4.5), planes are tried as well. If a
/// piece lies on both sides of the plane, both children refer to it, each with the box of its part,
/// unless it costs less to keep the whole piece on one side (section 4.4).
///
/// The result's `items` holds indices of pieces, at most twice as many as there are pieces. Boxes
/// bound the parts and are widened by `tolerance` (scene units): every point of a piece is in the
/// box of a leaf that refers to it. The result is the same with and without `options.parallel`.
BinaryBvh build_spatial_bvh(const scenes::Scene& scene, std::span<const PrimitivePart> pieces,
                            double tolerance, const BvhOptions& options);

}  // namespace beambench::accel::bvh
