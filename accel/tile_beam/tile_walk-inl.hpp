// Traces one tile's beam through the hierarchy, front to back.

#if defined(ACCEL_TILE_BEAM_TILE_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TILE_WALK_INL
#undef ACCEL_TILE_BEAM_TILE_WALK_INL
#else
#define ACCEL_TILE_BEAM_TILE_WALK_INL
#endif

#include <bit>

#include "accel/tile_beam/box_probe-inl.hpp"
#include "accel/tile_beam/cone_raster-inl.hpp"
#include "accel/tile_beam/hand_over.hpp"
#include "accel/tile_beam/meshlet_raster-inl.hpp"
#include "accel/tile_beam/prefetch-inl.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"
#include "accel/tile_beam/ray_walk-inl.hpp"
#include "accel/tile_beam/sphere_raster-inl.hpp"
#include "accel/tile_beam/tile_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The number of leaves per sample above which a part of the hierarchy is traversed by single rays.
inline constexpr float kHandoverLeaves = 1.0F;

/// Draws a tile.
template <class Counting>
class TileWalk {
 public:
  TileWalk(const TilePicture& picture, const TileView& view, TileImage& image, Counting& counting)
      : hierarchy_(&picture.hierarchy),
        scene_(&picture.scene),
        rays_{picture.rays, picture.raster, view},
        backs_(&picture.backs),
        view_(&view),
        probe_(view),
        image_(&image),
        counting_(&counting) {
    image.touched = false;
  }

  void operator()() {
    push_root();
    while (size_ > 0) {
      const Entry entry = stack_[--size_];
      if (entry.nearest < farthest_) continue;
      if (image_->touched && hides(*image_, entry.where, entry.nearest)) continue;
      visit(entry);
    }
  }

 private:
  struct Entry {
    TileChild child;
    float nearest;  ///< the largest 1/t of its box
    SampleRectangle where;
    /// Not 0 if there are more leaves than single rays would visit. A whole word, because entries
    /// with padding are copied in overlapping pieces, and reading them stalls.
    std::uint32_t crowded;
  };

  void push_root() {
    if (hierarchy_->empty()) return;
    TileBoxes boxes{};
    boxes.set(0, hierarchy_->bounds);
    BoxProbe::Met met;
    probe_.probe(boxes, 1, 0.0F, met);
    if (met.lanes == 0) return;
    stack_[size_++] = {
        hierarchy_->root, met.nearest[0], met.where(0),
        is_crowded(static_cast<std::uint32_t>(hierarchy_->leaves()), met.samples[0])};
  }

  /// Returns whether a part is crowded. Samples are counted on the whole screen, because most
  /// leaves of a part may lie outside the tile.
  static bool is_crowded(std::uint32_t leaves, float samples) {
    return static_cast<float>(leaves) > kHandoverLeaves * (samples + 1.0F);
  }

  HWY_INLINE void visit(const Entry& entry) {
    counting_->add(Counter::kTraversalSteps);
    if (entry.child.kind() != TileChild::Kind::kNode) {
      visit_leaf_of_tile(entry);
    } else if (entry.crowded) {
      hand_over(entry);
    } else {
      push_children(entry.child.index());
    }
  }

  HWY_INLINE void push_children(std::uint32_t number) {
    const TileNode& node = hierarchy_->nodes[number];
    counting_->add(Counter::kBoxTests, node.count);
    BoxProbe::Met met;
    probe_.probe(node.boxes, node.count, farthest_, met);
    const LaneBits fronts = met.lanes & backs_->hidden_lanes(*hierarchy_, number);
    if (fronts != 0) met.lanes &= ~(fronts & probe_.turned_away(node));
    Entry* const first = stack_.data() + size_;
    size_ += static_cast<std::size_t>(std::popcount(met.lanes));
    for (LaneBits left = met.lanes; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      prefetch_child(*hierarchy_, node.children[lane]);
      first[farther_lanes(met, lane)] = {node.children[lane], met.nearest[lane], met.where(lane),
                                         is_crowded(node.leaves[lane], met.samples[lane])};
    }
  }

  /// Returns how many of the boxes met are farther than a given box; this number is the box's place
  /// on the stack. Counting avoids a branch, which would be unpredictable. Of equally near boxes,
  /// the first lane counts as the farthest.
  static HWY_INLINE int farther_lanes(const BoxProbe::Met& met, std::size_t lane) {
    const Floats own = all(met.nearest[lane]);
    const LaneBits farther = for_each_register(
        [&](std::size_t other) { return hn::Lt(load(&met.nearest[other]), own); });
    const LaneBits equal = for_each_register(
        [&](std::size_t other) { return hn::Eq(load(&met.nearest[other]), own); });
    return std::popcount(met.lanes & (farther | (equal & ((LaneBits{1} << lane) - 1))));
  }

  HWY_INLINE void visit_leaf_of_tile(const Entry& entry) {
    counting_->add(Counter::kLeaves);
    if (!image_->touched) clear(*image_, *view_);
    switch (entry.child.kind()) {
      case TileChild::Kind::kMeshlet: {
        const Meshlet& meshlet = hierarchy_->meshlets[entry.child.index()];
        counting_->add_tests(scenes::PrimitiveKind::kPolygon, meshlet.triangle_count);
        draw_meshlet(meshlet, backs_->hidden(*hierarchy_, entry.child.index()), rays_, farthest_,
                     *image_);
        break;
      }
      case TileChild::Kind::kSpheres: {
        const SphereBlock& block = hierarchy_->spheres[entry.child.index()];
        counting_->add_tests(scenes::PrimitiveKind::kSphere, block.count);
        draw_spheres(block, *scene_, rays_, farthest_, *image_);
        break;
      }
      case TileChild::Kind::kCones: {
        const ConeBlock& block = hierarchy_->cones[entry.child.index()];
        counting_->add_tests(scenes::PrimitiveKind::kCone, block.count);
        counting_->add("doubtful_samples",
                       draw_cones(block, *scene_, rays_, probe_, farthest_, *image_));
        break;
      }
      case TileChild::Kind::kNode:
        break;
    }
    changed(entry.where);
  }

  /// Traces single rays for the remaining samples.
  void hand_over(const Entry& entry) {
    if (!image_->touched) clear(*image_, *view_);
    const SampleRectangle& where = entry.where;
    int x = where.left - 1;
    int y = where.top;
    const auto next = [&](Ray& ray, std::size_t& at) {
      for (;;) {
        if (++x > where.right) {
          x = where.left;
          ++y;
        }
        if (y > where.bottom) return false;
        at = TileImage::place(x, y);
        if (image_->inverse_t[at] <= entry.nearest) break;
      }
      note_handed_over(*counting_, at);
      ray = rays_.at(x, y);
      ray.t_max = 1.0F / image_->inverse_t[at];
      return true;
    };
    const auto done = [&](std::size_t at, const std::optional<Hit>& hit) {
      if (!hit) return;
      image_->inverse_t[at] = inverse_of(hit->t);
      image_->primitive[at] = hit->primitive;
    };
    answer_rays_below<ClosestQuery>(*hierarchy_, *scene_, entry.child, *counting_, next, done);
    changed(where);
  }

  /// Records that samples in a rectangle changed. Occasionally, when the whole tile's depth may
  /// have changed considerably, updates it.
  HWY_INLINE void changed(const SampleRectangle& where) {
    mark_stale(*image_, where);
    drawn_ += where.count();
    if (drawn_ < kTileWidth * kTileHeight) return;
    drawn_ = 0;
    farthest_ = farthest_of_all(*image_, open_cell_);
  }

  const TileHierarchy* hierarchy_;
  const scenes::Scene* scene_;
  TileRays rays_;
  const VisibleBacks* backs_;
  const TileView* view_;
  BoxProbe probe_;
  TileImage* image_;
  Counting* counting_;
  float farthest_ = 0.0F;   ///< the last known smallest 1/t of the tile
  unsigned open_cell_ = 0;  ///< where background was last found
  int drawn_ = 0;           ///< samples covered by leaves since `farthest_` was updated
  std::size_t size_ = 0;
  std::array<Entry, kMaxTileDepth*(kTileLanes - 1) + 1> stack_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
