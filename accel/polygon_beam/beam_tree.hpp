#pragma once
// The beams of one image, from the eye through the BSP tree; each ends at the first polygon it
// meets.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/polygon_beam/image_beam.hpp"
#include "accel/polygon_beam/polygon_tree.hpp"
#include "accel/polygon_beam/seen_fragment.hpp"

namespace beambench::accel::polygon_beam {

/// Sums that are added to the counters at the end of the counting pass.
struct BeamSums {
  std::uint64_t made = 1;  ///< the whole image, and the remaining parts of each cut beam
  std::uint64_t ended = 0;
  std::uint64_t left = 0;
  std::uint64_t dropped = 0;
  std::uint64_t clips = 0;
  std::uint64_t met = 0;
  std::uint64_t confirmed = 0;
  std::uint64_t undecided = 0;
};

/// The first level of Heckbert and Hanrahan's beam tree ("Beam tracing polygonal objects", SIGGRAPH
/// 1984): the beam of the whole image meets polygons from front to back. The part of a beam that a
/// polygon covers ends there; the rest, cut into convex beams, continues (Weiler and Atherton,
/// "Hidden surface removal using polygon area sorting", SIGGRAPH 1977). Deeper levels arrive as
/// separate queries.
///
/// Beam polygons in floating point never decide a hit. In a leaf, every sample of a beam is tested
/// by the canonical test against every polygon that it may hit before any beam ends; the nearest
/// hit is kept, with the lowest id among equal hits. A beam ends only where its samples certainly
/// hit a polygon within the leaf's cell (`SeenFragment::surely`). No other hit can be as near:
///
/// - Take any plane above the leaf in the tree, and let d be the distance from it, positive on the
///   side of the eye, which is visited first. Along a ray, d is linear, and not negative at the
///   eye. If the leaf is on this side, the hit has d >= -5/8 of the slab. Hits on primitives that
///   this side does not refer to have d < -7/8 of the slab: they come later, by more than the
///   rounding of t (`Sight::may_end`).
/// - If the leaf is on the other side, the beam has already passed the first side, where the sample
///   was tested against everything that it may hit there.
///
/// A sample on an edge is in no part that ends: it stays in the adjacent beams and is tested until
/// these beams end or leave. Beams without samples are dropped.
template <class Counting>
class BeamTree {
 public:
  /// `outlines` receives all beams that end or leave; may be null.
  BeamTree(const scenes::Scene& scene, const PolygonTree& tree, const PrimaryRays& rays,
           const HitSpan& hits, Counting& counting, std::vector<BeamOutline>* outlines)
      : scene_(&scene),
        tree_(&tree),
        rays_(&rays),
        hits_(hits),
        counting_(&counting),
        outlines_(outlines),
        screen_(rays),
        sight_(tree, screen_, glm::dvec3(rays.eye())),
        rows_(rays),
        best_triangle_(hits.size(), kNone) {}

  BeamSums trace() {
    std::fill_n(hits_.t(), hits_.size(), kInfinity);
    std::fill_n(hits_.primitive(), hits_.size(), scenes::kNoPrimitive);
    ImagePolygon image;
    image.push_back({0.0, 0.0});
    image.push_back({rays_->width(), 0.0});
    image.push_back({rays_->width(), rays_->height()});
    image.push_back({0.0, rays_->height()});
    Beams beams;
    beams.push_back(keep(image));
    visit(0, beams);
    for (const std::uint32_t beam : beams) leave(pool_[beam].outline);
    return sums_;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr bool kCounts = !std::is_same_v<Counting, NoCounting>;
  /// A factor that is below 1 by more than the rounding errors of t in float and of
  /// `SeenFragment::inverse_t` in double.
  static constexpr double kNearly = 1.0 - 0x1p-20;
  /// Beams with more corners are halved, so that there is space for the sides of a fragment.
  static constexpr std::size_t kMostOfBeam = ImagePolygon::capacity() - kMostSides - 1;

  /// Beams, as indices into the pool.
  using Beams = std::vector<std::uint32_t>;

  std::uint32_t keep(const ImagePolygon& polygon) {
    if (free_.empty()) {
      pool_.emplace_back(polygon);
      return static_cast<std::uint32_t>(pool_.size() - 1);
    }
    const std::uint32_t place = free_.back();
    free_.pop_back();
    pool_[place] = ImageBeam(polygon);
    return place;
  }

  /// Passes the beams that a node may hide through it, near side first, and puts back those that
  /// remain.
  void visit(std::size_t index, Beams& beams) {
    const TreeNode& node = tree_->nodes()[index];
    if (beams.empty() || node.box.lower.x > node.box.upper.x) return;
    const PixelBox box = sight_.box_of(node.box);
    if (box.empty()) return;
    Beams inside;
    std::erase_if(beams, [&](std::uint32_t beam) {
      if (!pool_[beam].overlaps(box)) return false;
      inside.push_back(beam);
      return true;
    });
    if (inside.empty()) return;
    counting_->add(Counter::kTraversalSteps);
    if (node.is_leaf) {
      meet(index, inside);
    } else {
      const bool in_front = node.plane.distance(sight_.eye()) >= 0.0;
      visit(node.first + (in_front ? 0UL : 1UL), inside);
      visit(node.first + (in_front ? 1UL : 0UL), inside);
    }
    beams.insert(beams.end(), inside.begin(), inside.end());
  }

  /// Tests the samples of beams against the polygons of a leaf; then ends the parts that the
  /// polygons certainly hide.
  void meet(std::size_t leaf, Beams& beams) {
    counting_->add(Counter::kLeaves);
    seen_.clear();
    for (const Fragment& fragment : tree_->fragments(tree_->nodes()[leaf])) {
      const SeenFragment seen = sight_.see(fragment);
      if (seen.box.empty()) continue;
      bool has_samples = false;
      for (const std::uint32_t beam : beams) {
        has_samples = test(fragment.triangle, seen, pool_[beam]) || has_samples;
      }
      if (has_samples && !seen.surely.empty()) seen_.push_back(seen);
    }
    Beams next;
    for (const SeenFragment& seen : seen_) {
      next.clear();
      for (const std::uint32_t beam : beams) cut(leaf, seen, beam, next);
      std::swap(beams, next);
    }
  }

  /// Narrows a polygon to the inner side of a line. Returns false if nothing is left.
  bool narrow(ImagePolygon& polygon, const ImageLine& line) {
    const beam::LineRange range = beam::range_over(polygon, line);
    if (range.high <= 0.0) return true;
    if (range.low > 0.0) return false;
    ++sums_.clips;
    polygon = beam::clip(polygon, line, 0.0);
    return !polygon.empty();
  }

  /// Tests the samples of a beam that may hit a fragment. Returns whether there are any such
  /// samples.
  bool test(std::uint32_t triangle, const SeenFragment& seen, const ImageBeam& beam) {
    if (!beam.overlaps(seen.box)) return false;
    ImagePolygon part = beam.outline;
    for (ImageLine line : seen.may) {
      // Samples of the beam may lie outside its polygon by up to `kBorder`; allow the same here.
      line.constant -= kBorder * (std::abs(line.x) + std::abs(line.y));
      if (!narrow(part, line)) return false;
    }
    bool has_samples = false;
    rows_.find_run(part, seen.box, [&](int y, int sample, int first, int last) {
      has_samples = true;
      const glm::dvec2& offset = rays_->offsets()[static_cast<std::size_t>(sample)];
      for (int x = first; x <= last; ++x) {
        const std::size_t index = hits_.index(x, y, sample);
        if (best_triangle_[index] == triangle) continue;
        // NaN, from an infinite limit, must not skip the sample.
        const double inverse_t = seen.inverse_t.at({x + offset.x, y + offset.y});
        if (inverse_t * hits_.t()[index] < kNearly) continue;
        confirm(triangle, rays_->ray(x, y, sample), index);
      }
      return false;
    });
    sums_.met += has_samples ? 1 : 0;
    return has_samples;
  }

  void confirm(std::uint32_t triangle, const Ray& ray, std::size_t index) {
    counting_->add_tests(scenes::PrimitiveKind::kPolygon);
    ClosestHit closest(ray);
    closest.keep(hits_.t()[index], hits_.primitive()[index]);
    const auto& [vertex, id] = scene_->triangles[triangle];
    const float t = intersect_triangle(closest.ray, scene_->vertices[vertex[0]],
                                       scene_->vertices[vertex[1]], scene_->vertices[vertex[2]]);
    if (!is_hit(t)) return;
    closest.keep(t, id);
    if (closest.primitive == id) best_triangle_[index] = triangle;
    hits_.set(index, closest.result());
  }

  /// Ends the part of a beam that a fragment certainly hides, and keeps the rest in `next`.
  void cut(std::size_t leaf, const SeenFragment& seen, std::uint32_t beam, Beams& next) {
    if (!pool_[beam].overlaps(seen.box)) return next.push_back(beam);
    beam::FixedVector<ImagePolygon, kMostSides> outside;
    ImagePolygon hidden = pool_[beam].outline;
    for (const ImageLine& line : seen.surely) {
      const ImagePolygon whole = hidden;
      if (!narrow(hidden, line)) return next.push_back(beam);
      if (beam::range_over(whole, line).high <= 0.0) continue;
      outside.push_back(beam::clip(whole, {-line.x, -line.y, -line.constant, 0.0}, 0.0));
    }
    // If the hidden part has no samples, do not cut the beam: that would only create more beams.
    if (!rows_.any_in(hidden)) return next.push_back(beam);
    free_.push_back(beam);
    for (const ImagePolygon& part : outside) go_on(part, next);
    end(leaf, hidden);
  }

  /// Keeps a part of a beam if it has samples; halves it if it has too many corners.
  void go_on(const ImagePolygon& part, Beams& next) {
    if (part.empty() || !rows_.any_in(part)) {
      ++sums_.dropped;
      return;
    }
    if (part.size() <= kMostOfBeam) {
      ++sums_.made;
      return next.push_back(keep(part));
    }
    ImagePolygon first;
    ImagePolygon second;
    const std::size_t middle = part.size() / 2;
    for (std::size_t i = 0; i <= middle; ++i) first.push_back(part[i]);
    for (std::size_t i = middle; i <= part.size(); ++i) second.push_back(part[i % part.size()]);
    go_on(first, next);
    go_on(second, next);
  }

  void end(std::size_t leaf, const ImagePolygon& part) {
    ++sums_.ended;
    if (!kCounts && outlines_ == nullptr) return;
    const std::vector<std::size_t> samples = samples_of(part);
    sums_.confirmed += samples.size();
    if (outlines_ == nullptr) return;
    outlines_->push_back({BeamKind::kOccupied, {part.begin(), part.end()}, leaf, samples});
  }
  void leave(const ImagePolygon& part) {
    ++sums_.left;
    if (!kCounts && outlines_ == nullptr) return;
    for (const std::size_t sample : samples_of(part)) sums_.undecided += hits_.get(sample) ? 1 : 0;
    if (outlines_ == nullptr) return;
    outlines_->push_back({BeamKind::kLeaving, {part.begin(), part.end()}});
  }
  std::vector<std::size_t> samples_of(const ImagePolygon& part) const {
    std::vector<std::size_t> samples;
    rows_.find_run(part, rows_.all(), [&](int y, int sample, int first, int last) {
      for (int x = first; x <= last; ++x) samples.push_back(hits_.index(x, y, sample));
      return false;
    });
    std::ranges::sort(samples);
    return samples;
  }

  const scenes::Scene* scene_;
  const PolygonTree* tree_;
  const PrimaryRays* rays_;
  HitSpan hits_;
  Counting* counting_;
  std::vector<BeamOutline>* outlines_;
  z_buffer::Screen screen_;
  Sight sight_;
  SampleRows rows_;
  /// For each sample, the triangle of its hit so far, whose other fragments need no test.
  std::vector<std::uint32_t> best_triangle_;
  std::vector<ImageBeam> pool_;
  Beams free_;
  std::vector<SeenFragment> seen_;
  BeamSums sums_;
};

}  // namespace beambench::accel::polygon_beam
