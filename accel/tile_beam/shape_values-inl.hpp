// Evaluates the numbers of a leaf's shape at places on a side of the cube: on which side of a
// triangle's edges and plane they lie.

#if defined(ACCEL_TILE_BEAM_SHAPE_VALUES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_SHAPE_VALUES_INL
#undef ACCEL_TILE_BEAM_SHAPE_VALUES_INL
#else
#define ACCEL_TILE_BEAM_SHAPE_VALUES_INL
#endif

#include <array>
#include <cstddef>

#include "accel/tile_beam/pencil_shapes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The numbers of one shape in all lanes.
struct OneShape {
  const SeenShapes& shapes;
  std::size_t shape;
  HWY_INLINE Floats operator()(std::size_t row) const { return all(shapes.rows[row][shape]); }
};

/// Returns the error bound of a ray origin's position relative to a triangle's plane.
HWY_INLINE Floats slack_of(const OneShape& of, Floats w) {
  return hn::MulAdd(of(SeenShapes::kSlackPerW), w, of(SeenShapes::kSlack));
}

using Edges = std::array<Floats, 3>;

HWY_INLINE Floats value_of(const OneShape& of, std::size_t row, Floats u, Floats v,
                           Floats constant) {
  return hn::MulAdd(of(row), u, hn::MulAdd(of(row + 1), v, constant));
}
HWY_INLINE Edges edges_of(const OneShape& of, Floats u, Floats v) {
  const auto edge = [&](std::size_t row) { return value_of(of, row, u, v, of(row + 2)); };
  return {edge(SeenShapes::kEdge0), edge(SeenShapes::kEdge0 + 3), edge(SeenShapes::kEdge0 + 6)};
}
HWY_INLINE Floats least_edge(const Edges& edges) {
  return hn::Min(edges[0], hn::Min(edges[1], edges[2]));
}
/// Returns how far behind a triangle's plane a ray begins, as seen from the apex; for any hits.
HWY_INLINE Floats beyond_plane(const OneShape& of, Floats u, Floats v, Floats w) {
  return value_of(of, SeenShapes::kPlane, u, v,
                  hn::NegMulAdd(of(SeenShapes::kDistance), w, of(SeenShapes::kPlane + 2)));
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
