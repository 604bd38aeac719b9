#include "accel/bvh/sah_bvh.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <hwy/targets.h>

#include "accel/bvh/refit.hpp"
#include "accel/core/threads.hpp"

namespace beambench::accel::bvh {
namespace {

/// Calls `trace(first, count, counting)` for each part of a list, which threads share.
template <class Trace>
void for_each_part(std::size_t rays, const QueryContext& context, const Trace& trace) {
  for_rows(context, static_cast<int>(Streams::parts(rays)),
           [&](int begin, int end, auto& counting) {
             for (int part = begin; part < end; ++part) {
               const auto number = static_cast<std::size_t>(part);
               const std::size_t first = Streams::begin_of(number, rays);
               trace(first, Streams::begin_of(number + 1, rays) - first, counting);
             }
           });
}

}  // namespace

std::vector<ParameterInfo> SahBvh::parameters() {
  const BvhOptions defaults;
  return {choice_parameter("builder", "binned", {"lbvh", "ploc", "binned", "sweep", "spatial"},
                           "from the fastest to the slowest build: lbvh: splits where Morton codes "
                           "differ (Lauterbach and others 2009); ploc: neighbors merge (Meister "
                           "and Bittner 2018); binned: splits by SAH between bins (Wald 2007); "
                           "sweep: best of all splits by SAH; spatial: splits may divide "
                           "primitives (Stich and others 2009)"),
          flag_parameter("reinsertion", false,
                         "after the build, reinsert nodes where they enlarge the hierarchy least "
                         "(Bittner and others 2013; Meister and Bittner 2018)"),
          choice_parameter("collapse", "area", {"area", "cost"},
                           "how two-way splits become eight-way nodes: by area, which suits single "
                           "rays, or at the least cost for streams"),
          integer_parameter("max_leaf", defaults.max_leaf, 1, 32,
                            "maximum number of primitives "
                            "in a leaf"),
          flag_parameter("parallel", defaults.parallel,
                         "use all cores for the build; the hierarchy is the same"),
          choice_parameter("lists", "streams", {"streams", "single"},
                           "streams: the rays of a list traverse the hierarchy together; "
                           "single: one by one"),
          update_parameter(),
          isa_parameter()};
}

SahBvhOptions SahBvh::options_from(const Parameters& parameters) {
  SahBvhOptions options;
  options.splits.max_leaf = static_cast<std::uint32_t>(parameters.integer("max_leaf"));
  options.splits.parallel = parameters.flag("parallel");
  const std::string& builder = parameters.choice("builder");
  if (builder == "lbvh") options.builder = BvhBuilder::kLbvh;
  if (builder == "ploc") options.builder = BvhBuilder::kPloc;
  if (builder == "sweep") options.builder = BvhBuilder::kSweep;
  if (builder == "spatial") options.builder = BvhBuilder::kSpatial;
  options.reinsertion = parameters.flag("reinsertion");
  if (parameters.choice("collapse") == "cost") options.collapse = BvhCollapse::kCost;
  options.streams = parameters.choice("lists") == "streams";
  return options;
}

SahBvh::SahBvh(const scenes::Scene& scene, const SahBvhOptions& options, std::int64_t targets)
    : scene_(&scene),
      bvh_(build_wide_bvh(scene, options)),
      streams_(options.streams),
      parallel_(options.splits.parallel),
      kernels_(&sah_kernels_for(targets)),
      stream_kernels_(&stream_kernels_for(targets)) {
  if (streams_) stream_tree_ = build_stream_tree(bvh_, parallel_);
}

bool SahBvh::update(const scenes::Scene& scene) {
  scene_ = &scene;
  refit(bvh_, scene, parallel_);
  if (streams_) stream_tree_ = build_stream_tree(bvh_, parallel_, std::move(stream_tree_));
  return true;
}

void SahBvh::closest_hits(const RaySource& rays, const HitSpan& hits,
                          const QueryContext& context) const {
  if (!is_stream(rays)) return TraversalAccelerator::closest_hits(rays, hits, context);
  const std::span<const Ray> all = rays.batch()->rays;
  for_each_part(all.size(), context, [&](std::size_t first, std::size_t count, auto& counting) {
    streams().closest_hits(
        all.subspan(first, count), hits.part(first, count), counting,
        [&](std::size_t i) { hits.set(first + i, find_closest(all[first + i], counting)); });
  });
}

void SahBvh::any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                      const QueryContext& context) const {
  if (!is_stream(rays)) return TraversalAccelerator::any_hits(rays, hits, context);
  const std::span<const Ray> all = rays.batch()->rays;
  for_each_part(all.size(), context, [&](std::size_t first, std::size_t count, auto& counting) {
    streams().any_hits(
        all.subspan(first, count), hits.subspan(first, count), counting,
        [&](std::size_t i) { hits[first + i] = find_any(all[first + i], counting) ? 1 : 0; });
  });
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
  if (bvh_.is_refit) return statistics;
  statistics.more = {{"cost", bvh_.cost}};
  bvh_.visits.append_to(statistics);
  return statistics;
}

void SahBvh::describe(TreeQuality& tree) const {
  if (bvh_.empty()) return;
  scenes::Bounds box = bvh_.scene_bounds;
  if (!bvh_.root.is_leaf()) box = bvh_.nodes[bvh_.root.node_index()].bounds();
  describe(bvh_.root, box, tree);
}

void SahBvh::describe(ChildReference child, const scenes::Bounds& box, TreeQuality& tree) const {
  tree.open(box);
  if (child.is_leaf()) {
    for (std::uint32_t i = 0; i < child.block_count(); ++i) {
      const PrimitiveBlock& block = bvh_.blocks[child.first_block() + i];
      for (std::uint32_t lane = 0; lane < block.count; ++lane) {
        tree.add_primitive(block.primitives[lane]);
      }
    }
  } else {
    const WideNode& node = bvh_.nodes[child.node_index()];
    for (std::uint32_t lane = 0; lane < node.count(); ++lane) {
      describe(node.children[lane], node.box(lane), tree);
    }
  }
  tree.close();
}

}  // namespace beambench::accel::bvh
