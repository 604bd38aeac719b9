#include "accel/bvh/sah_bvh.hpp"

#include <vector>

#include <hwy/targets.h>

#include "accel/core/threads.hpp"

namespace beambench::accel::bvh {
namespace {

/// Calls `trace(part, first, left, counting)` for parts of rays, and `trace_alone(i, counting)` for
/// those that it appends to `left`. Parts are shared among threads, but do not depend on their
/// number.
template <class Trace, class TraceAlone>
void trace_streams(std::span<const Ray> rays, const QueryContext& context, const Trace& trace,
                   const TraceAlone& trace_alone) {
  const std::size_t parts = (rays.size() + Stream::kMostRays - 1) / Stream::kMostRays;
  for_rows(context, static_cast<int>(parts), [&](int begin, int end, auto& counting) {
    std::vector<std::uint32_t> left;
    for (auto part = static_cast<std::size_t>(begin); part < static_cast<std::size_t>(end);
         ++part) {
      const std::size_t first = rays.size() * part / parts;
      const std::size_t last = rays.size() * (part + 1) / parts;
      left.clear();
      trace(rays.subspan(first, last - first), first, left, counting);
      for (const std::uint32_t i : left) trace_alone(first + i, counting);
      counting.add("stream_left", left.size());
    }
  });
}

}  // namespace

std::vector<ParameterInfo> SahBvh::parameters() {
  const BvhOptions defaults;
  return {choice_parameter("builder", "binned", {"binned", "spatial"},
                           "spatial: splits may divide primitives (Stich and others 2009)"),
          choice_parameter("collapse", "area", {"area", "cost"},
                           "of two-way splits into eight-way nodes: by area, which suits single "
                           "rays, or at the least cost for streams"),
          integer_parameter("max_leaf", defaults.max_leaf, 1, 32, "most primitives of a leaf"),
          flag_parameter("parallel", defaults.parallel,
                         "build on all cores; the hierarchy is the same"),
          choice_parameter("lists", "streams", {"streams", "single"},
                           "streams: the rays of a list go down together; single: one by one")};
}

SahBvhOptions SahBvh::options_from(const Parameters& parameters) {
  SahBvhOptions options;
  options.splits.max_leaf = static_cast<std::uint32_t>(parameters.integer("max_leaf"));
  options.splits.parallel = parameters.flag("parallel");
  if (parameters.choice("builder") == "spatial") options.builder = BvhBuilder::kSpatial;
  if (parameters.choice("collapse") == "cost") options.collapse = BvhCollapse::kCost;
  options.streams = parameters.choice("lists") == "streams";
  return options;
}

SahBvh::SahBvh(const scenes::Scene& scene, const SahBvhOptions& options)
    : scene_(&scene),
      bvh_(build_wide_bvh(scene, options)),
      streams_(options.streams),
      kernels_(&best_sah_kernels()),
      stream_kernels_(&best_stream_kernels()) {
  if (streams_) stream_tree_ = build_stream_tree(bvh_, options.splits.parallel);
}

void SahBvh::closest_hits(const RaySource& rays, const HitSpan& hits,
                          const QueryContext& context) const {
  if (!is_stream(rays)) return TraversalAccelerator::closest_hits(rays, hits, context);
  const std::span<const Ray> all = rays.batch()->rays;
  trace_streams(
      all, context,
      [&]<class Counting>(std::span<const Ray> part, std::size_t first,
                          std::vector<std::uint32_t>& left, Counting& counting) {
        Stream stream{bvh_, stream_tree_, *scene_, part};
        stream.t = hits.t() + first;
        stream.primitive = hits.primitive() + first;
        stream_kernels_->queries<Counting>().closest(stream, left, counting);
      },
      [&](std::size_t i, auto& counting) { hits.set(i, find_closest(all[i], counting)); });
}

void SahBvh::any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                      const QueryContext& context) const {
  if (!is_stream(rays)) return TraversalAccelerator::any_hits(rays, hits, context);
  const std::span<const Ray> all = rays.batch()->rays;
  trace_streams(
      all, context,
      [&]<class Counting>(std::span<const Ray> part, std::size_t first,
                          std::vector<std::uint32_t>& left, Counting& counting) {
        Stream stream{bvh_, stream_tree_, *scene_, part};
        stream.any = hits.data() + first;
        stream_kernels_->queries<Counting>().any(stream, left, counting);
      },
      [&](std::size_t i, auto& counting) { hits[i] = find_any(all[i], counting) ? 1 : 0; });
}

const char* SahBvh::instruction_set() const { return hwy::TargetName(kernels_->target); }

Statistics SahBvh::statistics() const {
  Statistics statistics;
  statistics.nodes = bvh_.nodes.size() + bvh_.leaves;
  statistics.leaves = bvh_.leaves;
  statistics.references = bvh_.references;
  statistics.depth = bvh_.depth;
  statistics.bytes = bvh_.nodes.capacity() * sizeof(WideNode) +
                     bvh_.blocks.capacity() * sizeof(PrimitiveBlock) + stream_tree_.bytes();
  statistics.instruction_set = instruction_set();
  statistics.more = {{"cost", bvh_.cost}};
  bvh_.visits.append_to(statistics);
  return statistics;
}

}  // namespace beambench::accel::bvh
