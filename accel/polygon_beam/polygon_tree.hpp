#pragma once
// A BSP tree over triangles, which orders them as seen from any eye (Fuchs, Kedem and Naylor 1980).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/overlap.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::polygon_beam {

struct TreeOptions {
  std::size_t max_polygons = 8;  ///< cells with more, not counting those in faces, are divided
  std::size_t max_depth = 32;    ///< maximum number of divisions of a cell
  std::uint64_t max_references = 10'000'000;  ///< maximum number of fragments of all leaves
};

/// The points where dot(normal, point) = offset. The normal has unit length.
struct Plane {
  glm::dvec3 normal{0.0};
  double offset = 0.0;

  double distance(const glm::dvec3& point) const { return glm::dot(normal, point) - offset; }
};

/// The part of a triangle that lies in the cell of a leaf, as two convex polygons: `outer` in the
/// cell widened by the tree's slab, `inner` in the cell widened by half of it.
struct Fragment {
  std::uint32_t triangle;
  std::uint32_t first = 0;  ///< index of the outer corners, which the inner ones follow
  std::uint16_t outer = 0;  ///< number of outer corners; 0: both polygons are the whole triangle
  std::uint16_t inner = 0;
};

struct TreeNode {
  Plane plane{};            ///< of an interior node; its front is where distances are > 0
  Box box{};                ///< of the fragments below; empty (lower > upper) if there are none
  std::uint32_t first = 0;  ///< the front child, which the back child follows; or a leaf's
                            ///< first fragment
  std::uint32_t count = 0;  ///< of a leaf: its fragments
  bool is_leaf = true;
};

/// Divides space by planes of polygons and planes across the axes, until few polygons remain in a
/// cell apart from those in its faces ("On visible surface generation by a priori tree structures",
/// SIGGRAPH 1980). The polygons of a leaf are not ordered.
///
/// Cells overlap: a fragment belongs to both sides of a plane if it comes within `slab()` of it. So
/// a polygon in a dividing plane belongs to the cells on both sides, and everything that touches it
/// is in the same leaf.
class PolygonTree {
 public:
  /// Throws InputError if there would be more than `max_references` fragments.
  PolygonTree(const scenes::Scene& scene, const TreeOptions& options);

  std::span<const TreeNode> nodes() const { return nodes_; }
  std::span<const Fragment> fragments() const { return fragments_; }
  std::span<const Fragment> fragments(const TreeNode& leaf) const {
    return std::span(fragments_).subspan(leaf.first, leaf.count);
  }
  using Triangle = std::array<glm::dvec3, 3>;
  Triangle triangle(std::uint32_t index) const;
  /// Returns the outer corners of a fragment; `whole` is its triangle and must outlive them.
  std::span<const glm::dvec3> outer(const Fragment& fragment, const Triangle& whole) const {
    if (fragment.outer == 0) return whole;
    return std::span(corners_).subspan(fragment.first, fragment.outer);
  }
  std::span<const glm::dvec3> inner(const Fragment& fragment, const Triangle& whole) const {
    if (fragment.outer == 0) return whole;
    return std::span(corners_).subspan(fragment.first + fragment.outer, fragment.inner);
  }

  /// Returns the width by which cells overlap on each side of a plane: 2^-16 of the scene's
  /// diagonal. It is far larger than the spacing of float in the t of hits from an eye that is not
  /// far away.
  double slab() const { return slab_; }
  std::size_t depth() const { return depth_; }
  std::size_t bytes() const;

 private:
  friend class TreeBuilder;

  const scenes::Scene* scene_;
  double slab_;
  std::size_t depth_ = 1;
  std::vector<TreeNode> nodes_;
  std::vector<Fragment> fragments_;
  std::vector<glm::dvec3> corners_;
};

}  // namespace beambench::accel::polygon_beam
