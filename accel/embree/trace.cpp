#include "accel/embree/trace.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "accel/embree/trace_list.hpp"

namespace beambench::embree {
namespace {

void trace_single(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                  HitBuffer& buffer) {
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        RTCRayHit query = to_embree_query(rays.ray(x, y, sample));
        intersect(scene.get(), context, query);
        const std::size_t index = buffer.index(x, y, sample);
        buffer.t()[index] = query.ray.tfar;
        buffer.primitive()[index] = scene.owner(query.hit.geomID, query.hit.primID);
      }
    }
  }
}

/// N rays through one sample of a block of pixels, kept from block to block.
template <int N>
class Block {
 public:
  static constexpr int kWidth = Packet<N>::kWidth;
  static constexpr int kHeight = N / kWidth;
  using Query = typename Packet<N>::Query;

  /// What is the same for all rays of an image and what Embree leaves alone.
  static void prepare(const PrimaryRays& rays, Query& query) {
    query = {};
    for (int i = 0; i < N; ++i) {
      query.ray.org_x[i] = rays.eye().x;
      query.ray.org_y[i] = rays.eye().y;
      query.ray.org_z[i] = rays.eye().z;
      query.ray.mask[i] = std::numeric_limits<unsigned>::max();
    }
  }

  /// The rest, for the block whose top left pixel is (x, y). Lanes off the image get an empty
  /// interval.
  static void aim(const PrimaryRays& rays, int x, int y, int sample, Query& query) {
    for (int i = 0; i < N; ++i) {
      const int px = x + i % kWidth;
      const int py = y + i / kWidth;
      const glm::vec3 direction = rays.ray(px, py, sample).direction;
      query.ray.dir_x[i] = direction.x;
      query.ray.dir_y[i] = direction.y;
      query.ray.dir_z[i] = direction.z;
      query.ray.tfar[i] = px < rays.width() && py < rays.height() ? kInfinity : -kInfinity;
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
  }

  static void write(const NativeScene& scene, const Query& query, int x, int y, int sample,
                    HitBuffer& buffer) {
    for (int i = 0; i < N; ++i) {
      const int px = x + i % kWidth;
      const int py = y + i / kWidth;
      if (px >= buffer.width() || py >= buffer.height()) continue;
      const std::size_t index = buffer.index(px, py, sample);
      buffer.t()[index] = query.ray.tfar[i];
      buffer.primitive()[index] = scene.owner(query.hit.geomID[i], query.hit.primID[i]);
    }
  }
};

template <int N>
void trace_packets(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                   HitBuffer& buffer) {
  using Block = Block<N>;
  typename Block::Query query;
  Block::prepare(rays, query);
  alignas(64) std::array<int, N> valid;
  for (int y = 0; y < rays.height(); y += Block::kHeight) {
    for (int x = 0; x < rays.width(); x += Block::kWidth) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        Block::aim(rays, x, y, sample, query);
        for (std::size_t i = 0; i < valid.size(); ++i) valid[i] = query.ray.tfar[i] > 0.0F ? -1 : 0;
        intersect(valid.data(), scene.get(), context, query);
        Block::write(scene, query, x, y, sample, buffer);
      }
    }
  }
}

#if BEAMBENCH_EMBREE_MAJOR == 3
/// Streams: all rays of one sample of a tile at once, as packets of 16.
void trace_stream(const NativeScene& scene, Context& context, const PrimaryRays& rays,
                  HitBuffer& buffer) {
  using Block = Block<16>;
  constexpr int kTile = 16;
  constexpr int kBlocks = (kTile / Block::kWidth) * (kTile / Block::kHeight);
  std::vector<Block::Query> queries(kBlocks);
  for (Block::Query& query : queries) Block::prepare(rays, query);

  for (int top = 0; top < rays.height(); top += kTile) {
    for (int left = 0; left < rays.width(); left += kTile) {
      const auto each_block = [&](auto&& action) {
        unsigned count = 0;
        for (int y = top; y < std::min(top + kTile, rays.height()); y += Block::kHeight) {
          for (int x = left; x < std::min(left + kTile, rays.width()); x += Block::kWidth) {
            action(x, y, queries[count++]);
          }
        }
        return count;
      };
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const unsigned count = each_block(
            [&](int x, int y, Block::Query& query) { Block::aim(rays, x, y, sample, query); });
        intersect_stream(scene.get(), context, queries.data(), count);
        each_block([&](int x, int y, const Block::Query& query) {
          Block::write(scene, query, x, y, sample, buffer);
        });
      }
    }
  }
}
#endif

constexpr TraceMode kModes[] = {
    {"single", trace_single, closest_hits_single, any_hits_single},
    {"packet4", trace_packets<4>, closest_hits_by_packets<4>, any_hits_by_packets<4>},
    {"packet8", trace_packets<8>, closest_hits_by_packets<8>, any_hits_by_packets<8>},
    {"packet16", trace_packets<16>, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#if BEAMBENCH_EMBREE_MAJOR == 3
    // Of a list there is no tile to make a stream of.
    {"stream", trace_stream, closest_hits_by_packets<16>, any_hits_by_packets<16>},
#endif
};

}  // namespace

std::span<const TraceMode> trace_modes() { return kModes; }

}  // namespace beambench::embree
