#pragma once
// Fragments of polygons as seen from an eye: where samples may hit them, and where samples
// certainly do.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/beam/image_polygon.hpp"
#include "accel/core/tolerance.hpp"
#include "accel/polygon_beam/polygon_tree.hpp"
#include "accel/z_buffer/screen.hpp"

namespace beambench::accel::polygon_beam {

using z_buffer::PixelBox;

/// The maximum number of corners of a fragment: each division of its cell adds at most one.
inline constexpr std::size_t kMostCorners = 64;
/// The maximum number of sides of the part of a fragment that ends beams. A beam's polygon has
/// space for them.
inline constexpr std::size_t kMostSides = 11;

/// A fragment on the image. Its lines are planes through the eye and an edge, so they are correct
/// wherever its corners lie, even behind the eye.
struct SeenFragment {
  PixelBox box;  ///< of all samples that may hit the fragment
  /// Lines on the image in pixels, negative on their inner side. A sample that may hit the fragment
  /// is inside all of them.
  beam::FixedVector<beam::ImageLine, kMostCorners> may;
  /// A sample inside all of these lines certainly hits the fragment. Empty if no sample certainly
  /// does.
  beam::FixedVector<beam::ImageLine, kMostSides> surely;
  beam::ImageLine inverse_t;  ///< at least 1 / view depth of its plane
};

/// Sees the fragments of a tree from the eye of an image.
///
/// Two statements hold, so that no hit is lost.
///
/// (1) A sample's canonical hit lies within s = kHitSlack * reach of the triangle
/// (accel/core/tolerance.hpp), so within s of one of its outer fragments, since these cover it.
/// Seen from the eye, at a distance of at least `height`, this is an angle of s / height; the
/// sample's direction, rounded to float, deviates by Screen::rounding(). `may` is widened by both.
///
/// (2) A sample inside `surely` has a canonical hit of the triangle, and the hit lies within the
/// leaf's cell widened by 5/8 of the slab: the inner fragment is in the cell widened by half of the
/// slab, and the conditions in `may_end` keep the error of the computed hit below an eighth of the
/// slab.
class Sight {
 public:
  Sight(const PolygonTree& tree, const z_buffer::Screen& screen, const glm::dvec3& eye)
      : tree_(&tree), screen_(&screen), eye_(eye) {
    const Box& box = tree.nodes().front().box;
    const glm::dvec3 largest =
        glm::max(glm::abs(eye), glm::max(glm::abs(box.lower), glm::abs(box.upper)));
    // The error of corners made by cutting with a plane, with a margin for products of two corners.
    corner_loss_ = 0x1p-48 * std::max({largest.x, largest.y, largest.z});
    const glm::dvec3 farthest = glm::max(glm::abs(box.lower - eye), glm::abs(box.upper - eye));
    scene_reach_ = glm::length(farthest);
  }

  glm::dvec3 from_eye(const glm::dvec3& point) const { return point - eye_; }
  const glm::dvec3& eye() const { return eye_; }

  /// Returns the pixels of the samples that may hit something in a box.
  PixelBox box_of(const Box& box) const {
    std::array<z_buffer::Ball, 8> hull;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const glm::dvec3 corner((i & 1U) != 0 ? box.upper.x : box.lower.x,
                              (i & 2U) != 0 ? box.upper.y : box.lower.y,
                              (i & 4U) != 0 ? box.upper.z : box.lower.z);
      hull[i] = {from_eye(corner), beside(scene_reach_)};
    }
    return screen_->box_of(hull);
  }

  /// Returns a fragment as seen from the eye; if its box is empty, only the box is set.
  SeenFragment see(const Fragment& fragment) const {
    SeenFragment seen;
    const PolygonTree::Triangle whole = tree_->triangle(fragment.triangle);
    const std::span<const glm::dvec3> outer = tree_->outer(fragment, whole);
    const Facing facing(*this, whole);
    beam::FixedVector<z_buffer::Ball, kMostCorners> hull;
    for (const glm::dvec3& corner : outer) {
      if (!hull.full()) hull.push_back({from_eye(corner), beside(facing.reach)});
    }
    seen.box = screen_->box_of({hull.begin(), hull.size()});
    if (seen.box.empty()) return seen;

    const double longest = screen_->longest();
    if (!(facing.height > 0x1p-20 * facing.reach) || !(facing.length > 0x1p-20 * facing.size)) {
      // Seen edge-on, or a needle whose plane is uncertain: only the box limits the samples.
      seen.inverse_t = {0.0, 0.0, std::numeric_limits<double>::infinity(), 0.0};
      return seen;
    }
    const double slack = screen_->rounding() * facing.length + 0x1p-46 * facing.size * longest;
    seen.inverse_t = line_of(facing.normal / facing.volume, slack / std::abs(facing.volume));
    add_outer(outer, facing, seen.may);
    if (may_end(facing)) add_inner(tree_->inner(fragment, whole), facing, seen.surely);
    return seen;
  }

 private:
  /// A triangle relative to the eye.
  struct Facing {
    Facing(const Sight& sight, const PolygonTree::Triangle& whole) {
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = sight.from_eye(whole[i]);
        reach = std::max(reach, glm::length(corners[i]));
      }
      const glm::dvec3 side = corners[1] - corners[0];
      const glm::dvec3 other = corners[2] - corners[0];
      normal = glm::cross(side, other);
      length = glm::length(normal);
      size = glm::length(side) * glm::length(other);
      volume = glm::dot(normal, corners[0]);
      height = length > 0.0 ? std::abs(volume) / length : 0.0;
    }

    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal;
    double reach = 0.0;  ///< distance of the farthest corner
    double length;       ///< of the normal
    double size;         ///< the length that `normal` would have if the sides were perpendicular
    double volume;
    double height;  ///< distance of the plane
  };

  /// Returns how far from a primitive a hit may lie, with a margin.
  static double beside(double reach) { return 4.0 * kHitSlack * reach; }

  /// Returns dot(normal, direction) + slack as a function of the place in pixels.
  beam::ImageLine line_of(const glm::dvec3& normal, double slack) const {
    const z_buffer::PixelLine line = screen_->product(normal, slack);
    return {line.x, line.y, line.constant, 0.0};
  }

  /// The plane through the eye and two corners. `loss` bounds the error of the product of `normal`
  /// and a sample's direction.
  struct EdgePlane {
    glm::dvec3 normal;
    double loss;
  };
  EdgePlane plane_through(const glm::dvec3& from, const glm::dvec3& to) const {
    const glm::dvec3 normal = glm::cross(from, to);
    const double length = glm::length(normal);
    const double loss = corner_loss_ * (glm::length(from) + glm::length(to)) * screen_->longest();
    return {normal / length, loss / length};
  }

  void add_outer(std::span<const glm::dvec3> corners, const Facing& facing,
                 decltype(SeenFragment::may)& lines) const {
    const double outward = facing.volume > 0.0 ? -1.0 : 1.0;
    const double wider =
        screen_->rounding() + screen_->longest() * beside(facing.reach) / facing.height;
    for (std::size_t i = 0; i < corners.size() && !lines.full(); ++i) {
      const EdgePlane plane =
          plane_through(from_eye(corners[i]), from_eye(corners[(i + 1) % corners.size()]));
      // An edge seen as a point limits nothing; the other edges do.
      if (!(plane.loss < kLoosest * screen_->longest())) continue;
      lines.push_back(line_of(outward * plane.normal, -wider - plane.loss));
    }
  }

  /// Adds the lines of the inner fragment, moved inward, or no lines if they are not certain.
  /// Corners may be dropped, which only shrinks the polygon.
  void add_inner(std::span<const glm::dvec3> corners, const Facing& facing,
                 decltype(SeenFragment::surely)& lines) const {
    beam::FixedVector<glm::dvec3, kMostSides> kept;
    const auto certain = [&](const glm::dvec3& from, const glm::dvec3& to) {
      return plane_through(from, to).loss < screen_->rounding();
    };
    for (const glm::dvec3& corner : corners) {
      const glm::dvec3 place = from_eye(corner);
      if (kept.full()) break;
      if (kept.empty() || certain(kept[kept.size() - 1], place)) kept.push_back(place);
    }
    while (kept.size() >= 3 && !certain(kept[kept.size() - 1], kept[0])) {
      kept.resize(kept.size() - 1);
    }
    if (kept.size() < 3) return;
    const double outward = facing.volume > 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const EdgePlane plane = plane_through(kept[i], kept[(i + 1) % kept.size()]);
      lines.push_back(line_of(outward * plane.normal, 2.0 * screen_->rounding() + plane.loss));
    }
  }

  /// Returns whether statement (2) holds for a triangle.
  bool may_end(const Facing& facing) const {
    const double longest = screen_->longest();
    // Canonical hits of everything else near the cell are in it: they lie within an eighth of the
    // slab of their primitive.
    if (!(kHitSlack * scene_reach_ <= 0.125 * tree_->slab())) return false;
    // An eighth of the slab exceeds the rounding error of t in float, so anything farther behind
    // the cell has a larger t, not an equal one. It also exceeds the error in double of a hit at a
    // grazing angle; the error of the plane's normal is 2^-50 * size / length.
    if (!(0x1p-20 * facing.reach * longest <= tree_->slab())) return false;
    if (!(facing.length > 0x1p-10 * facing.size)) return false;
    if (!(facing.height > 0x1p-14 * facing.reach)) return false;
    // The error of the canonical areas is 2^-48 of these products, which is negligible compared to
    // a line's margin.
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& from = facing.corners[i];
      const glm::dvec3& to = facing.corners[(i + 1) % 3];
      if (!(glm::length(glm::cross(from, to)) > 0x1p-20 * glm::length(from) * glm::length(to))) {
        return false;
      }
    }
    return true;
  }

  /// The largest error, as an angle, of a line that is used.
  static constexpr double kLoosest = 0x1p-10;

  const PolygonTree* tree_;
  const z_buffer::Screen* screen_;
  glm::dvec3 eye_;
  double corner_loss_ = 0.0;
  double scene_reach_ = 0.0;
};

}  // namespace beambench::accel::polygon_beam
