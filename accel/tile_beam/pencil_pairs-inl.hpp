// Determines which blocks of a part of a pencil must be tested against which shapes of a leaf.

#if defined(ACCEL_TILE_BEAM_PENCIL_PAIRS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_PAIRS_INL
#undef ACCEL_TILE_BEAM_PENCIL_PAIRS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_PAIRS_INL
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "accel/tile_beam/pencil_groups-inl.hpp"
#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/shape_values-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The numbers of several shapes, one per lane (OneShape has those of a single shape). The types
/// for blocks are analogous.
struct SomeShapes {
  const SeenShapes& shapes;
  std::size_t lane;
  HWY_INLINE Floats operator()(std::size_t row) const { return shapes.at(row, lane); }
};
struct OneBlock {
  std::size_t place;
  HWY_INLINE Floats operator()(const float* values) const { return all(values[place]); }
};
struct SomeBlocks {
  std::size_t place;
  HWY_INLINE Floats operator()(const float* values) const { return load(values + place); }
};

/// Finds the pairs by the bounds of groups, then by those of blocks, a triangle's edges and its
/// plane.
template <class Policy>
class PencilPairs {
 public:
  PencilPairs(const PencilUnit& unit, const PencilGroups<Policy>& groups, const SeenShapes& shapes)
      : unit_(&unit), groups_(&groups), shapes_(&shapes) {}

  /// Finds the pairs of some groups and `count` shapes of a leaf within bounds.
  template <bool kTriangles>
  HWY_INLINE void find(const SideBounds& bounds, std::uint32_t groups, std::size_t count) {
    list_candidates(bounds, groups, count);
    test_blocks<kTriangles>(count);
  }
  /// Returns the last pairs found: place of the block * SeenShapes::kMax + shape.
  std::span<const std::uint32_t> found() const { return {pairs_.data(), count_}; }

 private:
  static constexpr bool kClosest = Policy::kClosest;

  using Numbers = hn::Vec<hn::RebindToUnsigned<Tag>>;

  /// Writes the numbers of some lanes consecutively, and returns how many.
  static HWY_INLINE std::size_t append(Numbers numbers, Mask which, std::uint32_t* to) {
    const hn::RebindToUnsigned<Tag> d;
    return compress_store(d, numbers, hn::RebindMask(d, which), to);
  }

  /// Lists what to test: for each group, either some shapes, each with all blocks, or some blocks,
  /// each with all shapes, whichever takes fewer tests.
  HWY_INLINE void list_candidates(const SideBounds& bounds, std::uint32_t groups,
                                  std::size_t count) {
    const hn::RebindToUnsigned<Tag> d;
    std::size_t by_shape_count = 0;
    std::size_t by_block_count = 0;
    const std::size_t shape_registers = (count + kLanes - 1) / kLanes;
    for (; groups != 0; groups &= groups - 1) {
      const auto group = static_cast<std::size_t>(std::countr_zero(groups));
      const std::size_t first = group * 16;
      const LaneBits blocks = groups_->blocks_in(group, bounds);
      const PencilBounds within = groups_->bounds_of(group);
      LaneBits shapes = 0;
      for (std::size_t lane = 0; lane < count; lane += kLanes) {
        const SeenBounds seen{
            shapes_->at(SeenShapes::kLowU, lane), shapes_->at(SeenShapes::kHighU, lane),
            shapes_->at(SeenShapes::kLowV, lane), shapes_->at(SeenShapes::kHighV, lane),
            shapes_->at(SeenShapes::kLowW, lane), shapes_->at(SeenShapes::kHighW, lane)};
        shapes |= bits_of(hn::Not(is_negative(apart<Policy>(seen, within, groups_->spread()))))
                  << lane;
      }
      shapes &= shapes_->present;
      // Both lists are appended to without a branch: the list not chosen does not grow.
      const std::size_t registers_of_group = 16 / kLanes;
      const bool by_block = static_cast<std::size_t>(std::popcount(blocks)) * shape_registers <
                            static_cast<std::size_t>(std::popcount(shapes)) * registers_of_group;
      const LaneBits some_blocks = by_block ? blocks : 0;
      const LaneBits some_shapes = by_block || blocks == 0 ? 0 : shapes;
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        by_block_count += append(hn::Iota(d, static_cast<std::uint32_t>(first + lane)),
                                 lanes_of(some_blocks, lane), &by_block_[by_block_count]);
      }
      for (std::size_t lane = 0; lane < count; lane += kLanes) {
        by_shape_count +=
            append(hn::Iota(d, static_cast<std::uint32_t>(group * SeenShapes::kMax + lane)),
                   lanes_of(some_shapes, lane), &by_shape_[by_shape_count]);
      }
    }
    by_shape_count_ = by_shape_count;
    by_block_count_ = by_block_count;
  }

  /// Sets the sign of lanes whose shape cannot hit any ray of the block.
  template <bool kTriangles, class Shape, class Block>
  HWY_INLINE Floats misses(Shape shape, Block block) const {
    const PencilUnit& unit = *unit_;
    const Floats minus_w = block(unit.minus_w.data());
    const Floats nearer = hn::Add(minus_w, shape(SeenShapes::kHighW));
    const Floats more = groups_->widening(nearer);
    const auto plus = PencilGroups<Policy>::plus;
    Floats out =
        either(hn::Sub(plus(block(unit.high_u.data()), more), shape(SeenShapes::kLowU)),
               hn::Add(plus(block(unit.minus_low_u.data()), more), shape(SeenShapes::kHighU)),
               hn::Sub(plus(block(unit.high_v.data()), more), shape(SeenShapes::kLowV)));
    out =
        either(out, hn::Add(plus(block(unit.minus_low_v.data()), more), shape(SeenShapes::kHighV)),
               nearer);
    if constexpr (kClosest) {
      out = hn::Or(out, hn::Sub(block(unit.origin_w_top.data()), shape(SeenShapes::kLowW)));
    }
    if constexpr (kTriangles) {
      const Floats middle_u = block(unit.middle_u.data());
      const Floats middle_v = block(unit.middle_v.data());
      const Floats half_u = block(unit.half_u.data());
      const Floats half_v = block(unit.half_v.data());
      // The largest value of a line over the block.
      const auto largest = [&](std::size_t row, std::size_t magnitudes, Floats constant,
                               Floats along_u, Floats along_v) {
        return hn::MulAdd(
            shape(row), middle_u,
            hn::MulAdd(shape(row + 1), middle_v,
                       hn::MulAdd(shape(magnitudes), along_u,
                                  hn::MulAdd(shape(magnitudes + 1), along_v, constant))));
      };
      const Floats wider_u = plus(half_u, more);
      const Floats wider_v = plus(half_v, more);
      const auto edge = [&](std::size_t k) {
        return largest(SeenShapes::kEdge0 + 3 * k, SeenShapes::kMagnitudes + 2 * k,
                       shape(SeenShapes::kEdge0 + 3 * k + 2), wider_u, wider_v);
      };
      out = either(out, edge(0), edge(1));
      out = either(
          out, edge(2),
          largest(SeenShapes::kPlane, SeenShapes::kMagnitudes + 6,
                  hn::MulAdd(shape(SeenShapes::kDistance), minus_w, shape(SeenShapes::kPlane + 2)),
                  half_u, half_v));
    }
    return out;
  }

  /// Lists the pairs of a block and a shape whose rays must be tested.
  template <bool kTriangles>
  HWY_INLINE void test_blocks(std::size_t shapes) {
    const hn::RebindToUnsigned<Tag> d;
    std::size_t count = 0;
    const std::size_t by_shapes = by_shape_count_;
    const std::size_t by_blocks = by_block_count_;
    constexpr auto kMax = static_cast<std::uint32_t>(SeenShapes::kMax);
    for (std::size_t i = 0; i < by_shapes; ++i) {
      const std::size_t shape = by_shape_[i] % kMax;
      const std::size_t first = by_shape_[i] / kMax * 16;
      for (std::size_t lane = 0; lane < 16; lane += kLanes) {
        const Mask hit = hn::Not(
            is_negative(misses<kTriangles>(OneShape{*shapes_, shape}, SomeBlocks{first + lane})));
        const auto pair = hn::ShiftLeft<5>(hn::Iota(d, static_cast<std::uint32_t>(first + lane)));
        count += append(hn::Or(pair, hn::Set(d, static_cast<std::uint32_t>(shape))), hit,
                        &pairs_[count]);
      }
    }
    for (std::size_t i = 0; i < by_blocks; ++i) {
      const std::uint32_t place = by_block_[i];
      for (std::size_t lane = 0; lane < shapes; lane += kLanes) {
        const Mask hit =
            hn::AndNot(is_negative(misses<kTriangles>(SomeShapes{*shapes_, lane}, OneBlock{place})),
                       lanes_of(shapes_->present >> lane, 0));
        count += append(hn::Iota(d, place * kMax + static_cast<std::uint32_t>(lane)), hit,
                        &pairs_[count]);
      }
    }
    count_ = count;
  }

  const PencilUnit* unit_;
  const PencilGroups<Policy>* groups_;
  const SeenShapes* shapes_;
  std::size_t by_shape_count_ = 0;
  std::size_t by_block_count_ = 0;
  std::size_t count_ = 0;
  /// The list has room for a register after the last entry.
  std::array<std::uint32_t, PencilUnit::kGroups * SeenShapes::kMax + 16> by_shape_;
  std::array<std::uint32_t, PencilUnit::kPlaces + 16> by_block_;
  std::array<std::uint32_t, PencilUnit::kPlaces * SeenShapes::kMax + 16> pairs_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
