#include "accel/embree/image_tracers.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "accel/core/pick_target.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/embree/image_tracers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "accel/embree/packet_owners-inl.hpp"
#include "accel/embree/unit_directions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::embree::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The rays through one sample of each pixel of a block, for a packet of N.
template <int N>
class Block {
 public:
  static constexpr int kWidth = Packet<N>::kWidth;
  static constexpr int kHeight = N / kWidth;
  using Query = typename Packet<N>::Query;

  /// Sets the values that are the same for all rays of an image and that Embree does not change.
  static void prepare(const PrimaryRays& rays, Query& query) {
    query = {};
    std::fill_n(query.ray.org_x, N, rays.eye().x);
    std::fill_n(query.ray.org_y, N, rays.eye().y);
    std::fill_n(query.ray.org_z, N, rays.eye().z);
    std::fill_n(query.ray.mask, N, std::numeric_limits<unsigned>::max());
  }

  /// Prepares the blocks whose top row of pixels is `y`.
  Block(const PrimaryRays& rays, int y, int sample) : rays_(rays), y_(y), sample_(sample) {
    const Doubles doubles;
    for (std::size_t lane = 0; lane < N; lane += hn::Lanes(doubles)) {
      const auto row = hn::Add(hn::Set(doubles, y), hn::Load(doubles, &kRowOfLane[lane]));
      const auto py = hn::Add(row, hn::Set(doubles, offset().y));
      for (int axis = 0; axis < 3; ++axis) {
        const auto down = hn::Mul(hn::Set(doubles, rays.down()[axis]), py);
        hn::Store(down, doubles, &down_[static_cast<std::size_t>(axis)][lane]);
      }
    }
  }

  /// Sets the remaining values for the block whose left column of pixels is `x`. As Embree
  /// requires, `valid` is -1 for each lane on the image and 0 for all other lanes, which get an
  /// empty interval.
  void aim(int x, Query& query, int* valid) const {
    const Floats floats;
    const hn::RebindToSigned<Floats> numbers;
    const hn::RebindToUnsigned<Floats> words;
    for (std::size_t lane = 0; lane < N; lane += hn::Lanes(floats)) {
      hn::Store(direction(x, 0, lane), floats, query.ray.dir_x + lane);
      hn::Store(direction(x, 1, lane), floats, query.ray.dir_y + lane);
      hn::Store(direction(x, 2, lane), floats, query.ray.dir_z + lane);
      hn::Store(hn::Set(floats, kInfinity), floats, query.ray.tfar + lane);
      hn::Store(hn::Set(words, RTC_INVALID_GEOMETRY_ID), words, query.hit.geomID + lane);
      hn::Store(hn::Set(numbers, -1), numbers, valid + lane);
    }
    if (is_on_image(x)) return;
    for (int lane = 0; lane < N; ++lane) {
      if (is_on_image(x, lane)) continue;
      query.ray.tfar[lane] = -kInfinity;
      valid[lane] = 0;
    }
  }

  /// Writes the hits of a block. Always inline, because otherwise GCC 12 warns of an infinite loop.
  HWY_INLINE void write(const OwnerTable& table, const Query& query, int x,
                        const HitSpan& buffer) const {
    alignas(64) std::array<scenes::PrimitiveId, N> owners;
    find_owners<N>(table, query.hit, owners.data());
    if (rays_.samples() == 1 && is_on_image(x)) {
      for (int row = 0; row < kHeight; ++row) {
        const std::size_t index = buffer.index(x, y_ + row, 0);
        copy_row(query.ray.tfar + row * kWidth, buffer.t() + index);
        copy_row(owners.data() + row * kWidth, buffer.primitive() + index);
      }
      return;
    }
    for (int lane = 0; lane < N; ++lane) {
      if (!is_on_image(x, lane)) continue;
      const std::size_t index = buffer.index(x + lane % kWidth, y_ + lane / kWidth, sample_);
      buffer.t()[index] = query.ray.tfar[lane];
      buffer.primitive()[index] = owners[static_cast<std::size_t>(lane)];
    }
  }

 private:
  using Floats = hn::CappedTag<float, N>;
  using Doubles = hn::CappedTag<double, hn::MaxLanes(Floats())>;

  static constexpr std::array<double, N> count_lanes(int (*place)(int lane)) {
    std::array<double, N> places{};
    for (int lane = 0; lane < N; ++lane) places[static_cast<std::size_t>(lane)] = place(lane);
    return places;
  }
  alignas(64) static constexpr std::array<double, N> kColumnOfLane = count_lanes([](int lane) {
    return lane % kWidth;
  });
  alignas(64) static constexpr std::array<double, N> kRowOfLane = count_lanes([](int lane) {
    return lane / kWidth;
  });

  bool is_on_image(int x) const {
    return x + kWidth <= rays_.width() && y_ + kHeight <= rays_.height();
  }
  bool is_on_image(int x, int lane) const {
    return x + lane % kWidth < rays_.width() && y_ + lane / kWidth < rays_.height();
  }

  const glm::dvec2& offset() const { return rays_.offsets()[static_cast<std::size_t>(sample_)]; }

  /// Returns one component of the directions of a register of lanes from `lane` on.
  hn::Vec<Floats> direction(int x, int axis, std::size_t lane) const {
    const Doubles doubles;
    const hn::Rebind<float, Doubles> rounded;
    const auto some = [&](std::size_t first) {
      const auto column = hn::Add(hn::Set(doubles, x), hn::Load(doubles, &kColumnOfLane[first]));
      const auto px = hn::Add(column, hn::Set(doubles, offset().x));
      const auto across = hn::Add(hn::Set(doubles, rays_.top_left()[axis]),
                                  hn::Mul(hn::Set(doubles, rays_.right()[axis]), px));
      const auto down = hn::Load(doubles, &down_[static_cast<std::size_t>(axis)][first]);
      return hn::DemoteTo(rounded, hn::Add(across, down));
    };
    // The register is stored as a whole, as Embree loads it, so that the load does not wait for two
    // stores. `Combine` is found by its arguments' namespace, since the scalar target lacks it.
    if constexpr (hn::MaxLanes(Doubles()) == hn::MaxLanes(Floats())) {
      return some(lane);
    } else {
      return Combine(Floats(), some(lane + hn::Lanes(doubles)), some(lane));
    }
  }

  template <class T>
  static void copy_row(const T* from, T* to) {
    const hn::CappedTag<T, kWidth> tag;
    for (std::size_t lane = 0; lane < kWidth; lane += hn::Lanes(tag)) {
      hn::StoreU(hn::Load(tag, from + lane), tag, to + lane);
    }
  }

  alignas(64) std::array<std::array<double, N>, 3> down_;  ///< down * py of each lane
  const PrimaryRays& rays_;
  int y_;
  int sample_;
};

/// Calls `trace_tile(left, top, right, bottom)` for all tiles of a band.
template <class TraceTile>
void for_each_tile(const PrimaryRays& rays, const Band& band, TraceTile trace_tile) {
  for (int top = band.top; top < band.bottom; top += kTile) {
    for (int left = 0; left < rays.width(); left += kTile) {
      trace_tile(left, top, std::min(left + kTile, rays.width()),
                 std::min(top + kTile, band.bottom));
    }
  }
}

/// Traces a band block by block; `trace_block(query, valid)` finds the closest hits of a packet.
template <int N, class TraceBlock>
void trace_blocks(const OwnerTable& owners, const PrimaryRays& rays, const Band& band,
                  const HitSpan& buffer, TraceBlock trace_block) {
  typename Block<N>::Query query;
  Block<N>::prepare(rays, query);
  alignas(64) std::array<int, N> valid;
  for_each_tile(rays, band, [&](int left, int top, int right, int bottom) {
    for (int y = top; y < bottom; y += Block<N>::kHeight) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const Block<N> block(rays, y, sample);
        for (int x = left; x < right; x += Block<N>::kWidth) {
          block.aim(x, query, valid.data());
          trace_block(query, valid.data());
          block.write(owners, query, x, buffer);
        }
      }
    }
  });
}

template <int N>
void trace_packets(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                   const Band& band, const HitSpan& buffer) {
  trace_blocks<N>(
      scene.owners(), rays, band, buffer, [&](typename Packet<N>::Query& query, const int* valid) {
        trace_packet<N>(scene, query.ray, [&] { intersect(valid, scene.get(), context, query); });
      });
}

void trace_single(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                  const Band& band, const HitSpan& buffer) {
  constexpr int kLanes = 16;
  RTCRayHit one = to_embree_query({.origin = rays.eye()});
  const auto trace_each = [&](Packet<kLanes>::Query& query, const int* valid) {
    for (int lane = 0; lane < kLanes; ++lane) {
      if (valid[lane] == 0) continue;
      one.ray.dir_x = query.ray.dir_x[lane];
      one.ray.dir_y = query.ray.dir_y[lane];
      one.ray.dir_z = query.ray.dir_z[lane];
      one.ray.tfar = kInfinity;
      one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      intersect(scene.get(), context, one);
      query.ray.tfar[lane] = one.ray.tfar;
      query.hit.geomID[lane] = one.hit.geomID;
      query.hit.primID[lane] = one.hit.primID;
    }
  };
  trace_blocks<kLanes>(scene.owners(), rays, band, buffer,
                       [&](Packet<kLanes>::Query& query, const int* valid) {
                         trace_packet<kLanes>(scene, query.ray, [&] { trace_each(query, valid); });
                       });
}

#if BEAMBENCH_EMBREE_MAJOR == 3
void trace_stream(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                  const Band& band, const HitSpan& buffer) {
  // Embree's own packet width is that of its registers: 4, 8 or 16. It copies the rays of other
  // packets one by one (kernels/bvh/bvh_intersector_stream_filters, filterSOA).
  constexpr int kLanes = std::max(4, static_cast<int>(hn::MaxLanes(hn::CappedTag<float, 16>())));
  using Block = Block<kLanes>;
  constexpr std::size_t kBlocks = kTile * kTile / kLanes;
  std::vector<typename Block::Query> queries(kBlocks);
  for (typename Block::Query& query : queries) Block::prepare(rays, query);
  alignas(64) std::array<int, kLanes> valid;  // streams use only the interval

  for_each_tile(rays, band, [&](int left, int top, int right, int bottom) {
    for (int sample = 0; sample < rays.samples(); ++sample) {
      const auto each_block = [&](auto&& action) {
        unsigned count = 0;
        for (int y = top; y < bottom; y += Block::kHeight) {
          const Block block(rays, y, sample);
          for (int x = left; x < right; x += Block::kWidth) action(block, x, queries[count++]);
        }
        return count;
      };
      const unsigned count = each_block([&](const Block& block, int x, Block::Query& query) {
        block.aim(x, query, valid.data());
      });
      trace_packets_at_once<kLanes>(
          scene, queries, count, [](Block::Query & query) -> auto& { return query.ray; },
          [&] { intersect_stream(scene.get(), context, queries.data(), count); });
      each_block([&](const Block& block, int x, const Block::Query& query) {
        block.write(scene.owners(), query, x, buffer);
      });
    }
  });
}
#else
constexpr ImageTracers::Trace trace_stream = nullptr;
#endif

void trace_nothing(const OwnerTable& owners, const PrimaryRays& rays, const Band& band,
                   const HitSpan& buffer) {
  constexpr int kLanes = 16;
  trace_blocks<kLanes>(owners, rays, band, buffer,
                       [](Packet<kLanes>::Query& query, const int* valid) {
                         // Makes the compiler assume that the whole query is used.
                         asm volatile("" : "+m"(query) : "r"(valid) : "memory");
                       });
}

const ImageTracers& tracers_of_images() {
  static constexpr ImageTracers kTracers{trace_single,      trace_packets<4>, trace_packets<8>,
                                         trace_packets<16>, trace_stream,     trace_nothing,
                                         HWY_TARGET};
  return kTracers;
}

}  // namespace beambench::accel::embree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::embree {

HWY_EXPORT(tracers_of_images);

int tile_rows(const PrimaryRays& rays) { return (rays.height() + kTile - 1) / kTile; }

Band band_of(const PrimaryRays& rays, int begin, int end) {
  return {begin * kTile, std::min(end * kTile, rays.height())};
}

const ImageTracers& image_tracers(std::int64_t targets) {
  return pick_target(HWY_DISPATCH_TABLE(tracers_of_images), targets)();
}

}  // namespace beambench::accel::embree
#endif
