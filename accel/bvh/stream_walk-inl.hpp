// The traversal of the wide hierarchy by a stream of rays, for the instruction set being compiled.

#if defined(ACCEL_BVH_STREAM_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_BVH_STREAM_WALK_INL
#undef ACCEL_BVH_STREAM_WALK_INL
#else
#define ACCEL_BVH_STREAM_WALK_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <hwy/highway.h>

#include "accel/bvh/stream_hits-inl.hpp"
#include "accel/bvh/stream_kernels.hpp"
#include "accel/bvh/stream_memory.hpp"
#include "accel/bvh/stream_rows-inl.hpp"
#include "accel/bvh/stream_tests-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::bvh::HWY_NAMESPACE {

/// Children of a node, or triangles of a block, in lanes.
using LaneTag = hn::CappedTag<float, kBvhLanes>;
using Lanes = hn::Vec<LaneTag>;
inline constexpr std::size_t kRegister = hn::MaxLanes(LaneTag());

HWY_INLINE LaneBits lane_bits(hn::Mask<LaneTag> mask) {
  std::array<std::uint8_t, 8> stored{};
  hn::StoreMaskBits(LaneTag(), mask, stored.data());
  return stored[0];
}

/// Calls `test(lane)` for the first lane of each register of children or triangles, and combines
/// the masks it returns.
template <class Test>
HWY_INLINE LaneBits test_lanes(Test test) {
  LaneBits bits = 0;
  for (std::size_t lane = 0; lane < kBvhLanes; lane += kRegister) {
    bits |= lane_bits(test(lane)) << lane;
  }
  return bits;
}

/// Calls `visit(lane)` for each bit.
template <class Visit>
HWY_INLINE void for_each_bit(LaneBits bits, Visit visit) {
  for (; bits != 0; bits &= bits - 1) visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Traverses the hierarchy with all rays of a stream together, with a list of rays for each child
/// of a node.
///
/// Rays in a list have only one thing in common: they meet the same box. They are tested against a
/// box with one ray per lane, without idle lanes, and no branch depends on the outcome (Tsakok,
/// "Faster incoherent rays: Multi-BVH ray stream tracing", 2009). Children are visited in one order
/// for all rays, by the children's distances from the mean origin. (Barringer and Akenine-Moeller,
/// "Dynamic ray stream traversal", 2014, keep an order for each ray; Fuetterling and others,
/// "Efficient ray tracing kernels for modern CPU architectures", 2015, keep one for each octant.)
///
/// A list of `kPacket` rays or fewer stays in registers, with masks instead of lists; a list of
/// `kFew` rays or fewer continues ray by ray, with boxes and triangles in lanes.
template <bool kAny, class Counting>
class StreamWalk {
 public:
  /// Traces the stream. Appends to `left` the rays that no stream can trace.
  StreamWalk(const Stream& stream, StreamMemory& memory, std::vector<std::uint32_t>& left,
             Counting& counting)
      : stream_(stream),
        tree_(stream.tree),
        rows_(memory.rows.data()),
        lists_end_(memory.lists.data() + StreamMemory::entries_for(stream.rays.size())),
        counting_(counting),
        hits_(stream, memory, counting) {
    std::uint32_t* const all = memory.lists.data();
    const std::size_t count = stream.rays.size();
    extent_ = fill_rows<kAny>(stream.rays, tree_, rows_, left);
    for (std::size_t i = 0; i < count; ++i) all[i] = place_of(i);
    visit(stream.bvh.root, all, count, all + stride_of(count));
    hits_.finish();
  }

 private:
  using Hits = StreamHits<kAny, Counting>;
  static constexpr std::size_t kPacket = StreamMemory::kPacket;
  static constexpr std::size_t kFew = 2;

  /// Returns the number of entries for a list of at most `count` rays.
  static std::size_t stride_of(std::size_t count) {
    return (count + kPacket - 1) / kPacket * kPacket + kPacket;
  }
  Ray& row(std::uint32_t place) const { return row_at(rows_, place); }

  /// Visits a child with the rays that meet its box; there must be at least one. `free`: where new
  /// lists may be stored.
  void visit(ChildReference at, std::uint32_t* list, std::size_t count, std::uint32_t* free) {
    // Lanes beyond the end read a valid ray.
    std::fill_n(list + count, kPacket, list[0]);
    if (count <= kFew) {
      for (std::size_t i = 0; i < count; ++i) visit_alone(at, list[i]);
    } else if (at.is_leaf()) {
      visit_leaf(at, list, count);
    } else if (count <= kPacket) {
      visit_packet(at, list, count);
    } else {
      visit_node(at, list, count, free);
    }
  }

  void visit_node(ChildReference at, const std::uint32_t* list, std::size_t count,
                  std::uint32_t* free) {
    const StreamNode& node = tree_.nodes[at.node_index()];
    const std::size_t stride = stride_of(count);
    if (free + kBvhLanes * stride > lists_end_) return visit_in_packets(at, list, count);
    counting_.add("stream_lists");
    counting_.add("stream_rays", count);
    counting_.add("stream_chunks", (count + kPacket - 1) / kPacket);
    count_node(node, count);

    std::array<std::uint32_t*, kBvhLanes> ends;
    for (std::size_t lane = 0; lane < kBvhLanes; ++lane) ends[lane] = free + lane * stride;
    const LaneBits near = children_near(node);
    const hn::RebindToUnsigned<Tag> words;
    for (std::size_t i = 0; i < count; i += kLanes) {
      const LaneRays<Tag> rays = load_rays(rows_, list + i);
      const SlabLanes<Tag> slabs(rays, tree_);
      const auto places = hn::LoadU(words, list + i);
      const Mask present = hn::FirstN(Tag(), count - i);
      for (std::size_t lane = 0; lane < node.count; ++lane) {
        if (kAny && (near >> lane & 1U) == 0) continue;  // the same for all rays
        const Mask met = hn::And(meet(node, lane, slabs, rays), present);
        ends[lane] += compress_store(words, places, hn::RebindMask(words, met), ends[lane]);
      }
    }

    const std::array<std::uint8_t, kBvhLanes> order = order_of(node);
    std::uint32_t* const rest = free + kBvhLanes * stride;
    for (std::size_t lane = 0; lane < node.count; ++lane) {
      if (ends[lane] != free + lane * stride) prefetch(node.children[lane]);
    }
    for (std::size_t i = 0; i < node.count; ++i) {
      const std::size_t lane = order[i];
      std::uint32_t* const begin = free + lane * stride;
      const auto met = static_cast<std::size_t>(ends[lane] - begin);
      if (met > 0) visit(node.children[lane], begin, met, rest);
    }
  }

  void visit_in_packets(ChildReference at, const std::uint32_t* list, std::size_t count) {
    for (std::size_t i = 0; i < count; i += kPacket) {
      visit_packet(at, list + i, std::min(count - i, kPacket));
    }
  }

  /// Returns the children that overlap the box of all rays. Used only for any-hit queries, whose
  /// rays mostly end near their origins.
  HWY_INLINE LaneBits children_near(const StreamNode& node) const {
    if constexpr (!kAny) return ~LaneBits{0};
    const LaneTag tag;
    return test_lanes([&](std::size_t lane) {
      auto meets = hn::FirstN(tag, kBvhLanes);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto center = hn::Load(tag, &node.center[axis][lane]);
        const auto half = hn::Load(tag, &node.half[axis][lane]);
        const auto i = static_cast<int>(axis);
        meets = hn::And(meets, hn::Le(hn::Sub(center, half), hn::Set(tag, extent_.upper[i])));
        meets = hn::And(meets, hn::Ge(hn::Add(center, half), hn::Set(tag, extent_.lower[i])));
      }
      return meets;
    });
  }

  HWY_INLINE static Mask meet(const StreamNode& node, std::size_t lane, const SlabLanes<Tag>& slabs,
                              const LaneRays<Tag>& rays) {
    const auto box = [&](const auto& rows) -> Triple<Tag> {
      return {all(rows[0][lane]), all(rows[1][lane]), all(rows[2][lane])};
    };
    Floats enter;
    return slabs.meet(box(node.center), box(node.half), rays.t_min, rays.t_max, enter);
  }

  /// Returns the children in order of distance from the mean origin; for any-hit queries, in stored
  /// order.
  HWY_INLINE std::array<std::uint8_t, kBvhLanes> order_of(const StreamNode& node) const {
    std::array<std::uint8_t, kBvhLanes> order{0, 1, 2, 3, 4, 5, 6, 7};
    if constexpr (kAny) return order;
    const LaneTag tag;
    const hn::RebindToSigned<LaneTag> ints;
    alignas(64) std::array<std::int32_t, kBvhLanes> keys;
    alignas(64) std::array<std::int32_t, kBvhLanes> ranks;
    for (std::size_t lane = 0; lane < kBvhLanes; lane += kRegister) {
      auto distance = hn::Zero(tag);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto from_center =
            hn::Abs(hn::Sub(hn::Load(tag, &node.center[axis][lane]),
                            hn::Set(tag, extent_.middle[static_cast<int>(axis)])));
        const auto from_box =
            hn::Max(hn::Sub(from_center, hn::Load(tag, &node.half[axis][lane])), hn::Zero(tag));
        // Boxes that contain the mean are at distance 0 and are ordered by the distance of their
        // centers.
        distance = hn::MulAdd(from_box, from_box, distance);
        distance = hn::MulAdd(hn::Mul(from_center, hn::Set(tag, 1e-4F)), from_center, distance);
      }
      // Nonnegative floats are ordered like their bits; the last three bits make them distinct.
      const auto key = hn::Or(hn::And(hn::BitCast(ints, distance), hn::Set(ints, ~7)),
                              hn::Iota(ints, static_cast<std::int32_t>(lane)));
      hn::Store(key, ints, &keys[lane]);
    }
    for (std::size_t lane = 0; lane < kBvhLanes; lane += kRegister) {
      const auto key = hn::Load(ints, &keys[lane]);
      auto rank = hn::Zero(ints);
      for (const std::int32_t other : keys) {
        rank = hn::Sub(rank, hn::VecFromMask(ints, hn::Gt(key, hn::Set(ints, other))));
      }
      hn::Store(rank, ints, &ranks[lane]);
    }
    for (std::size_t lane = 0; lane < kBvhLanes; ++lane) {
      order[static_cast<std::size_t>(ranks[lane])] = static_cast<std::uint8_t>(lane);
    }
    return order;
  }

  void visit_leaf(ChildReference at, const std::uint32_t* list, std::size_t count) {
    counting_.add("stream_chunks", (count + kPacket - 1) / kPacket);
    count_leaf(at, count);
    for (std::size_t i = 0; i < count; i += kLanes) {
      LaneRays<Tag> rays = load_rays(rows_, list + i);
      const Mask present = hn::FirstN(Tag(), count - i);
      test_leaf(at, rays, hn::And(present, hn::Le(rays.t_min, rays.t_max)), list + i);
    }
  }

  /// Tests the primitives of a leaf against rays in lanes, and shortens rays that hit, both in
  /// their rows and in `rays`.
  HWY_INLINE void test_leaf(ChildReference at, LaneRays<Tag>& rays, Mask active,
                            const std::uint32_t* places) {
    for (std::uint32_t i = 0; i < at.block_count(); ++i) {
      const std::uint32_t index = at.first_block() + i;
      const StreamBlock& block = tree_.blocks[index];
      if (block.kind == scenes::PrimitiveKind::kPolygon) {
        test_triangles(block, rays, active, places);
      } else {
        test_solids(stream_.bvh.blocks[index], rays, active, places);
      }
    }
  }

  HWY_INLINE void test_triangles(const StreamBlock& block, LaneRays<Tag>& rays, Mask active,
                                 const std::uint32_t* places) {
    const TriangleLanes<Tag> triangle(rays, tree_, block.leaf_extent);
    const auto point = [](const auto& from, std::size_t lane) -> Triple<Tag> {
      return {all(from[0][lane]), all(from[1][lane]), all(from[2][lane])};
    };
    const hn::RebindToUnsigned<Tag> words;
    Mask ended = mask_of(0);
    Floats low = all(kInfinity);
    auto nearest = hn::Set(words, kNoTriangle);
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      const auto found =
          triangle(point(block.a, lane), point(block.from_c, lane), point(block.to_b, lane),
                   point(block.normal, lane), all(block.size[lane]), rays.t_max);
      const std::uint32_t number = block.first + static_cast<std::uint32_t>(lane);
      const Mask possible = hn::And(found.possible, active);
      Mask certain = hn::And(found.certain, active);
      if constexpr (kAny) {
        ended = hn::Or(ended, certain);
      } else {
        certain = hn::And(certain, hn::Lt(found.t_high, low));
        rays.t_max = hn::IfThenElse(certain, found.t_high, rays.t_max);
        low = hn::IfThenElse(certain, found.t_low, low);
        nearest = hn::IfThenElse(hn::RebindMask(words, certain), hn::Set(words, number), nearest);
      }
      const Mask doubtful = hn::AndNot(certain, possible);
      if (HWY_UNLIKELY(!hn::AllFalse(Tag(), doubtful))) {
        for_each_bit(bits_of(doubtful), [&](std::size_t i) { hits_.doubt(places[i], number); });
      }
    }
    if constexpr (kAny) {
      rays.t_max = hn::IfThenElse(ended, all(Hits::kEnded), rays.t_max);
      for_each_bit(bits_of(ended), [&](std::size_t i) { hits_.end(places[i]); });
    } else {
      const LaneBits hit = bits_of(hn::Lt(low, all(kInfinity)));
      if (hit == 0) return;
      alignas(64) std::array<float, kLanes> t_low;
      alignas(64) std::array<float, kLanes> t_high;
      alignas(64) std::array<std::uint32_t, kLanes> numbers;
      store(low, t_low.data());
      store(rays.t_max, t_high.data());
      hn::Store(nearest, words, numbers.data());
      for_each_bit(hit, [&](std::size_t i) {
        hits_.keep(places[i], {t_low[i], numbers[i]}, t_high[i]);
      });
    }
  }

  /// Tests spheres and cones and decides possible hits at once; for a cone, every ray is a possible
  /// hit.
  HWY_INLINE void test_solids(const PrimitiveBlock& block, LaneRays<Tag>& rays, Mask active,
                              const std::uint32_t* places) {
    const bool are_spheres = block.kind == scenes::PrimitiveKind::kSphere;
    const SphereLanes<Tag> sphere(rays, tree_);
    for (std::size_t lane = 0; lane < block.count; ++lane) {
      Mask possible = active;
      if (are_spheres) {
        const auto& rows = block.coordinates;
        possible =
            hn::And(possible, sphere({all(rows[0][lane]), all(rows[1][lane]), all(rows[2][lane])},
                                     all(rows[3][lane]), rays.t_max));
      }
      const LaneBits bits = bits_of(possible);
      if (bits == 0) continue;
      for_each_bit(bits, [&](std::size_t i) { hits_.decide(places[i], block.primitives[lane]); });
      rays.t_max = load_t_max(places);
    }
  }

  HWY_INLINE Floats load_t_max(const std::uint32_t* places) const {
    alignas(64) std::array<float, kLanes> t_max;
    for (std::size_t i = 0; i < kLanes; ++i) t_max[i] = row(places[i]).t_max;
    return load(t_max.data());
  }

  /// A short list of rays, which stays in registers.
  struct Packet {
    alignas(64) std::array<std::uint32_t, 2 * kPacket> places;
    std::array<LaneRays<Tag>, kPacket / kLanes> rays;
    LaneBits live;
  };

  /// Calls `visit(part, lanes)` for each register of a packet that has lanes in `active`.
  template <class Visit>
  HWY_INLINE static void for_each_part(LaneBits active, Visit visit) {
    for (std::size_t part = 0; part < kPacket / kLanes; ++part) {
      const LaneBits lanes = active >> part * kLanes & ((LaneBits{1} << kLanes) - 1);
      if (lanes != 0) visit(part, lanes);
    }
  }

  HWY_NOINLINE void visit_packet(ChildReference root, const std::uint32_t* list,
                                 std::size_t count) {
    counting_.add("stream_packets");
    struct Waiting {
      std::uint32_t at;  // bits: a ChildReference would be initialized
      LaneBits lanes;
    };
    Packet packet;
    std::copy_n(list, kPacket, packet.places.begin());
    std::array<Waiting, kRoom> waiting;
    std::size_t size = 0;
    waiting[size++] = {root.bits(), (LaneBits{1} << count) - 1};
    for_each_part(waiting[0].lanes, [&](std::size_t part, LaneBits) {
      packet.rays[part] = load_rays(rows_, &packet.places[part * kLanes]);
    });
    while (size > 0) {
      const Waiting next = waiting[--size];
      const auto at = ChildReference::from_bits(next.at);
      LaneBits lanes = next.lanes;
      if constexpr (kAny) {
        LaneBits live = 0;
        for_each_part(lanes, [&](std::size_t part, LaneBits) {
          const auto& rays = packet.rays[part];
          live |= bits_of(hn::Le(rays.t_min, rays.t_max)) << part * kLanes;
        });
        lanes &= live;
        if (lanes == 0) continue;
      }
      if (static_cast<std::size_t>(std::popcount(lanes)) <= kFew) {
        for_each_bit(lanes, [&](std::size_t lane) { visit_alone(at, packet.places[lane]); });
        for_each_part(lanes, [&](std::size_t part, LaneBits) {
          packet.rays[part].t_max = load_t_max(&packet.places[part * kLanes]);
        });
        continue;
      }
      counting_.add("stream_chunks");
      const auto present = static_cast<std::size_t>(std::popcount(lanes));
      if (at.is_leaf()) {
        count_leaf(at, present);
        for_each_part(lanes, [&](std::size_t part, LaneBits active) {
          test_leaf(at, packet.rays[part], mask_of(active), &packet.places[part * kLanes]);
        });
        continue;
      }
      const StreamNode& node = tree_.nodes[at.node_index()];
      count_node(node, present);
      std::array<LaneBits, kBvhLanes> met{};
      for_each_part(lanes, [&](std::size_t part, LaneBits active) {
        const LaneRays<Tag>& rays = packet.rays[part];
        const SlabLanes<Tag> slabs(rays, tree_);
        for (std::size_t lane = 0; lane < node.count; ++lane) {
          met[lane] |= (bits_of(meet(node, lane, slabs, rays)) & active) << part * kLanes;
        }
      });
      const std::array<std::uint8_t, kBvhLanes> order = order_of(node);
      for (std::size_t i = kBvhLanes; i-- > 0;) {  // the nearest on top
        const std::size_t lane = order[i];
        if (met[lane] == 0) continue;
        waiting[size++] = {node.children[lane].bits(), met[lane]};
        prefetch(node.children[lane]);
      }
    }
  }

  /// Continues one ray singly, nearest child first.
  HWY_NOINLINE void visit_alone(ChildReference at, std::uint32_t place) {
    Ray& ray = row(place);
    if (!(ray.t_min <= ray.t_max)) return;
    counting_.add("stream_singles");
    const LaneTag tag;
    const auto in_lanes = [&](const glm::vec3& v) -> Triple<LaneTag> {
      return {hn::Set(tag, v.x), hn::Set(tag, v.y), hn::Set(tag, v.z)};
    };
    LaneRays<LaneTag> lanes{in_lanes(ray.origin), hn::Set(tag, ray.t_min), in_lanes(ray.direction),
                            hn::Set(tag, ray.t_max)};
    if (at.is_leaf()) return test_leaf_alone(at, lanes, place);
    const SlabLanes<LaneTag> slabs(lanes, tree_);
    struct Waiting {
      std::uint32_t at;
      float enter;
    };
    std::array<Waiting, kRoom> waiting;
    std::size_t size = 0;
    while (true) {
      if (at.is_leaf()) {
        test_leaf_alone(at, lanes, place);
        if (kAny && ray.t_max == Hits::kEnded) return;
        lanes.t_max = hn::Set(tag, ray.t_max);
      } else {
        const StreamNode& node = tree_.nodes[at.node_index()];
        count_node(node, 1);
        alignas(64) std::array<float, kBvhLanes> enter;
        LaneBits met = test_lanes([&](std::size_t lane) {
          const auto box = [&](const auto& rows) -> Triple<LaneTag> {
            return {hn::Load(tag, &rows[0][lane]), hn::Load(tag, &rows[1][lane]),
                    hn::Load(tag, &rows[2][lane])};
          };
          Lanes enters;
          const auto meets =
              slabs.meet(box(node.center), box(node.half), lanes.t_min, lanes.t_max, enters);
          hn::Store(enters, tag, &enter[lane]);
          return meets;
        });
        if (met != 0) {
          const auto first = static_cast<std::size_t>(std::countr_zero(met));
          Waiting nearest{node.children[first].bits(), enter[first]};
          const std::size_t base = size;
          for_each_bit(met & (met - 1), [&](std::size_t lane) {
            Waiting other{node.children[lane].bits(), enter[lane]};
            if (!kAny && other.enter < nearest.enter) std::swap(other, nearest);
            std::size_t to = size++;
            for (; !kAny && to > base && waiting[to - 1].enter < other.enter; --to) {
              waiting[to] = waiting[to - 1];
            }
            waiting[to] = other;
          });
          at = ChildReference::from_bits(nearest.at);
          continue;
        }
      }
      do {
        if (size == 0) return;
        --size;
      } while (waiting[size].enter > ray.t_max);
      at = ChildReference::from_bits(waiting[size].at);
    }
  }

  HWY_INLINE void test_leaf_alone(ChildReference at, const LaneRays<LaneTag>& lanes,
                                  std::uint32_t place) {
    count_leaf(at, 1);
    for (std::uint32_t i = 0; i < at.block_count(); ++i) {
      const std::uint32_t index = at.first_block() + i;
      const StreamBlock& block = tree_.blocks[index];
      if (block.kind == scenes::PrimitiveKind::kPolygon) {
        test_triangles_alone(block, lanes, place);
      } else {
        test_solids_alone(stream_.bvh.blocks[index], lanes, place);
      }
      if (kAny && row(place).t_max == Hits::kEnded) return;
    }
  }

  HWY_INLINE void test_triangles_alone(const StreamBlock& block, const LaneRays<LaneTag>& lanes,
                                       std::uint32_t place) {
    const LaneTag tag;
    const TriangleLanes<LaneTag> triangle(lanes, tree_, block.leaf_extent);
    alignas(64) std::array<float, kBvhLanes> t_low;
    alignas(64) std::array<float, kBvhLanes> t_high;
    LaneBits certain = 0;
    LaneBits possible = test_lanes([&](std::size_t lane) {
      const auto point = [&](const auto& from) -> Triple<LaneTag> {
        return {hn::Load(tag, &from[0][lane]), hn::Load(tag, &from[1][lane]),
                hn::Load(tag, &from[2][lane])};
      };
      const auto found =
          triangle(point(block.a), point(block.from_c), point(block.to_b), point(block.normal),
                   hn::Load(tag, &block.size[lane]), lanes.t_max);
      hn::Store(found.t_low, tag, &t_low[lane]);
      hn::Store(found.t_high, tag, &t_high[lane]);
      certain |= lane_bits(found.certain) << lane;
      return found.possible;
    });
    possible &= (LaneBits{1} << block.count) - 1;
    certain &= possible;
    if constexpr (kAny) {
      if (certain != 0) return hits_.end(place);
    }
    for_each_bit(possible, [&](std::size_t lane) {
      const std::uint32_t number = block.first + static_cast<std::uint32_t>(lane);
      if constexpr (!kAny) {
        if ((certain >> lane & 1U) != 0) {
          return hits_.keep(place, {t_low[lane], number}, t_high[lane]);
        }
      }
      hits_.doubt(place, number);
    });
  }

  HWY_INLINE void test_solids_alone(const PrimitiveBlock& block, const LaneRays<LaneTag>& lanes,
                                    std::uint32_t place) {
    const LaneTag tag;
    LaneBits possible = ~LaneBits{0};
    if (block.kind == scenes::PrimitiveKind::kSphere) {
      const SphereLanes<LaneTag> sphere(lanes, tree_);
      possible = test_lanes([&](std::size_t lane) {
        const auto row = [&](std::size_t i) { return hn::Load(tag, &block.coordinates[i][lane]); };
        return sphere({row(0), row(1), row(2)}, row(3), lanes.t_max);
      });
    }
    for_each_bit(possible & ((LaneBits{1} << block.count) - 1),
                 [&](std::size_t lane) { hits_.decide(place, block.primitives[lane]); });
  }

  HWY_INLINE void prefetch(ChildReference child) const {
    if (child.is_leaf()) {
      prefetch_lines(tree_.blocks[child.first_block()]);
    } else {
      prefetch_lines(tree_.nodes[child.node_index()]);
    }
  }

  void count_node(const StreamNode& node, std::size_t rays) {
    counting_.add(Counter::kTraversalSteps, rays);
    counting_.add(Counter::kBoxTests, rays * node.count);
  }
  void count_leaf(ChildReference at, std::size_t rays) {
    counting_.add(Counter::kTraversalSteps, rays);
    counting_.add(Counter::kLeaves, rays);
    for (std::uint32_t i = 0; i < at.block_count(); ++i) {
      const StreamBlock& block = tree_.blocks[at.first_block() + i];
      counting_.add_tests(block.kind, rays * block.count);
    }
  }

  /// Each node on the longest path leaves at most seven children pending.
  static constexpr std::size_t kRoom = kMaxBvhDepth * (kBvhLanes - 1) + 1;

  const Stream& stream_;
  const StreamTree& tree_;
  Ray* rows_;
  const std::uint32_t* lists_end_;
  Counting& counting_;
  Hits hits_;
  RowsExtent extent_;
};

}  // namespace beambench::accel::bvh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
