#include "accel/tile_beam/tile_beam.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <hwy/cache_control.h>
#include <hwy/targets.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/tile_beam/pencil_bundle.hpp"
#include "accel/tile_beam/pencil_places.hpp"
#include "accel/tile_beam/tile_recorder.hpp"
#include "accel/tile_beam/tile_refit.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::tile_beam {

namespace {

/// A raster divided into tiles.
struct TiledRaster {
  SampleRaster raster;
  RasterView view;

  TiledRaster(const SampleRaster& from, const PrimaryRays& rays, const scenes::Bounds& scene)
      : raster(from), view(from, rays, scene) {}

  int columns() const { return (raster.width + kTileWidth - 1) / kTileWidth; }
  int rows() const { return (raster.height + kTileHeight - 1) / kTileHeight; }
  /// Returns a tile's view. Requires column < columns() and row < rows().
  TileView tile(int column, int row) const {
    const int left = column * kTileWidth;
    const int top = row * kTileHeight;
    return {view, left, top, std::min(kTileWidth, raster.width - left),
            std::min(kTileHeight, raster.height - top)};
  }
};

/// The rasters of an image with a common numbering of tiles: tiles in the same place, which write
/// to the same part of the buffer, have the same number.
class TiledImage {
 public:
  TiledImage(const PrimaryRays& rays, const scenes::Bounds& scene) {
    for (const SampleRaster& raster : sample_rasters(rays)) {
      rasters_.emplace_back(raster, rays, scene);
      columns_ = std::max(columns_, rasters_.back().columns());
      rows_ = std::max(rows_, rasters_.back().rows());
    }
  }

  int tiles() const { return columns_ * rows_; }
  /// Calls `draw(raster, view)` for all tiles with this number.
  template <class Draw>
  void for_each_of(int number, Draw draw) const {
    const int column = number % columns_;
    const int row = number / columns_;
    for (const TiledRaster& tiled : rasters_) {
      if (column < tiled.columns() && row < tiled.rows()) {
        draw(tiled.raster, tiled.tile(column, row));
      }
    }
  }

 private:
  std::vector<TiledRaster> rasters_;
  int columns_ = 0;
  int rows_ = 0;
};

/// The state of one thread.
template <class Counting>
struct ThreadState {
  std::unique_ptr<TileImage> image = std::make_unique_for_overwrite<TileImage>();
  Counting counting;
};

/// Traces an image in tiles. `parallel`: all cores share the tiles; hits and counts are the same.
template <class Counting>
void trace_tiles(const TileKernels& kernels, const TileHierarchy& hierarchy,
                 const scenes::Scene& scene, const PrimaryRays& rays, bool parallel,
                 const HitSpan& buffer, Counting& counting) {
  tbb::enumerable_thread_specific<ThreadState<Counting>> states;
  const TiledImage tiled(rays, hierarchy.bounds);
  const VisibleBacks backs(hierarchy, scene, rays.eye(), rays.count());
  const auto draw = [&](int begin, int end) {
    ThreadState<Counting>& own = states.local();
    for (int number = begin; number < end; ++number) {
      tiled.for_each_of(number, [&](const SampleRaster& raster, const TileView& view) {
        kernels.drawing<Counting>().draw({hierarchy, scene, rays, raster, backs}, view, *own.image,
                                         buffer, own.counting);
      });
    }
    hwy::FlushStream();
  };
  if (parallel) {
    tbb::parallel_for(tbb::blocked_range(0, tiled.tiles()),
                      [&](const auto& range) { draw(range.begin(), range.end()); });
  } else {
    draw(0, tiled.tiles());
  }
  for (const ThreadState<Counting>& state : states) counting.add(state.counting);
}

/// Returns how a sample of a tile was traced.
BeamPlace::Way way_of(const TileImage& image, const HandOverRecorder& recorder, std::size_t at) {
  if (recorder.is_handed_over[at]) return BeamPlace::Way::kHandedOver;
  return image.touched ? BeamPlace::Way::kInOrder : BeamPlace::Way::kBackground;
}

/// Consecutive rays of a batch: rays of a pencil, single rays, or origins of a bundle.
struct RayRange {
  std::size_t first;  ///< for a bundle: in its first pencil
  std::size_t count;
  const Pencil* pencil;     ///< or null
  std::size_t pencils = 1;  ///< for a bundle: their number, from `pencil` on
};

/// Returns the number of pencils in the bundle that begins with this pencil; 1 if there is none.
std::size_t bundled_from(const RayBatch& batch, std::size_t pencil) {
  if (batch.marks == nullptr) return 1;
  const std::vector<PencilBundle>& bundles = batch.marks->bundles;
  const auto at = std::ranges::lower_bound(bundles, pencil, {}, &PencilBundle::first);
  if (at == bundles.end() || at->first != pencil) return 1;
  if (at->count > batch.pencils.size() - pencil) return 1;
  return is_bundle(batch.pencils.subspan(pencil, at->count)) ? at->count : 1;
}

/// Returns all rays of a batch in order: as pencils whose direction matches `toward`, and all other
/// rays as parts of one stream each.
std::vector<RayRange> ranges_of(const RayBatch& batch, bool toward) {
  std::vector<RayRange> ranges;
  std::size_t next = 0;
  const auto single_until = [&](std::size_t end) {
    const std::size_t count = end - next;
    for (std::size_t part = 0; part < bvh::Streams::parts(count); ++part) {
      const std::size_t first = bvh::Streams::begin_of(part, count);
      ranges.push_back({next + first, bvh::Streams::begin_of(part + 1, count) - first, nullptr});
    }
  };
  for (std::size_t i = 0; i < batch.pencils.size();) {
    const Pencil& pencil = batch.pencils[i];
    const std::size_t bundled = bundled_from(batch, i);
    i += bundled;
    if (pencil.toward != toward || pencil.count < TileBeam::least_pencil(toward)) continue;
    single_until(pencil.first);
    ranges.push_back({pencil.first, pencil.count, &pencil, bundled});
    next = pencil.first + bundled * pencil.count;
  }
  single_until(batch.rays.size());
  return ranges;
}

/// A batch with the pencils that this structure supports.
struct SeenBatch {
  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  const PencilKernels& kernels;
  const RayBatch& batch;
  PencilSamples samples{batch};

  PencilRays pencil_rays(const RayRange& range) const {
    return {hierarchy, scene, batch.rays.subspan(range.first, range.count),
            samples.from(range.first), glm::vec3(range.pencil->apex)};
  }

  /// Returns the part of a bundle that has `count` origins, from origin number `first` on.
  BundlePart bundle_part(std::span<const Pencil> pencils, std::size_t first,
                         std::size_t count) const {
    return {hierarchy, scene, kernels, batch.rays, samples, pencils, first, count};
  }

  /// Returns ranges of rays; pencils are divided into parts that are traced at once.
  std::vector<RayRange> parts_of(std::span<const RayRange> ranges) const {
    std::vector<RayRange> parts;
    const auto unit = std::make_unique_for_overwrite<PencilUnit>();
    for (RayRange left : ranges) {
      while (left.count > 0) {
        const std::size_t count = left.pencil == nullptr ? left.count
                                  : left.pencils > 1 ? std::min(left.count, BundlePart::kOrigins)
                                                     : kernels.count_part(pencil_rays(left), *unit);
        parts.push_back({left.first, count, left.pencil, left.pencils});
        left.first += count;
        left.count -= count;
      }
    }
    return parts;
  }
};

/// The state of one thread.
template <class Counting>
struct QueryState {
  std::unique_ptr<PencilUnit> unit;  ///< created for the first pencil; most batches have none
  BundleMemory bundle;
  Counting counting;

  PencilUnit& made_unit() {
    if (!unit) unit = std::make_unique_for_overwrite<PencilUnit>();
    return *unit;
  }
};

/// Traces rays that are in no pencil by `query.stream` or, if they are few, by `query.list`; rays
/// that ProbeRay cannot probe are traced singly.
template <class Query, class Counting>
void trace_list(const Query& query, const std::optional<bvh::Streams>& streams,
                const RayRange& range, Counting& counting) {
  if (streams && range.count >= bvh::Streams::kLeast) {
    return query.stream(*streams, range, counting);
  }
  if (!query.list(range, counting)) return;
  for (std::size_t i = range.first; i < range.first + range.count; ++i) {
    if (!bvh::ProbeRay::can_probe(query.seen.batch.rays[i])) query.single(i, counting);
  }
}

/// The query for closest hits of a batch, part by part. Its pencils run away from an apex, like
/// rays from mirrors.
template <class Counting>
struct ClosestOfBatch {
  static constexpr bool kToward = false;
  const TileBeam& structure;
  const TileKernels& kernels;
  const SeenBatch& seen;
  const HitSpan& hits;

  AnsweredRays pencil(const PencilRays& rays, std::size_t first, PencilUnit& unit,
                      Counting& counting) const {
    return seen.kernels.queries<Counting>().closest_hits(rays, unit, hits, first, counting);
  }
  bool bundle(const BundlePart&, PencilUnit&, BundleMemory&, Counting&) const {
    return false;  // bundles run toward lights
  }
  bool is_undecided(std::size_t i) const { return hits.t()[i] == kUndecidedT; }
  void stream(const bvh::Streams& streams, const RayRange& range, Counting& counting) const {
    streams.closest_hits(seen.batch.rays.subspan(range.first, range.count),
                         hits.part(range.first, range.count), counting,
                         [&](std::size_t i) { single(range.first + i, counting); });
  }
  bool list(const RayRange& range, Counting& counting) const {
    return kernels.lists<Counting>().closest_hits(seen.hierarchy, seen.scene,
                                                  seen.batch.rays.subspan(range.first, range.count),
                                                  hits, range.first, counting);
  }
  void single(std::size_t i, Counting& counting) const {
    hits.set(i, structure.find_closest(seen.batch.rays[i], counting));
  }
};

/// The query for any hits of a batch, part by part. Its pencils run toward an apex, like shadow
/// rays.
template <class Counting>
struct AnyOfBatch {
  static constexpr bool kToward = true;
  const TileBeam& structure;
  const TileKernels& kernels;
  const SeenBatch& seen;
  std::span<std::uint8_t> hits;

  AnsweredRays pencil(const PencilRays& rays, std::size_t first, PencilUnit& unit,
                      Counting& counting) const {
    return seen.kernels.queries<Counting>().any_hits(
        rays, unit, hits.subspan(first, rays.rays.size()), counting);
  }
  /// Returns false if nothing was written, because tracing the part's pencils separately is faster.
  bool bundle(const BundlePart& part, PencilUnit& unit, BundleMemory& memory,
              Counting& counting) const {
    if (!find_hidden(part, unit, memory, hits, counting)) return false;
    trace_open(part, memory, hits, [&](std::span<const Ray> rays, std::span<std::uint8_t> found) {
      const RayBatch list{rays};
      const SeenBatch seen_list{seen.hierarchy, seen.scene, seen.kernels, list};
      trace_list(AnyOfBatch{structure, kernels, seen_list, found}, structure.streams(),
                 {0, rays.size(), nullptr}, counting);
    });
    return true;
  }
  bool is_undecided(std::size_t i) const { return hits[i] == kUndecided; }
  void stream(const bvh::Streams& streams, const RayRange& range, Counting& counting) const {
    streams.any_hits(seen.batch.rays.subspan(range.first, range.count),
                     hits.subspan(range.first, range.count), counting,
                     [&](std::size_t i) { single(range.first + i, counting); });
  }
  bool list(const RayRange& range, Counting& counting) const {
    return kernels.lists<Counting>().any_hits(seen.hierarchy, seen.scene,
                                              seen.batch.rays.subspan(range.first, range.count),
                                              hits.subspan(range.first, range.count), counting);
  }
  void single(std::size_t i, Counting& counting) const {
    hits[i] = structure.find_any(seen.batch.rays[i], counting) ? 1 : 0;
  }
};

/// Traces a batch: its pencils by `query.pencil`, then the rays left undecided singly, and all
/// other rays by `trace_list`. `parallel`: parts are distributed among all cores; hits and counts
/// are the same.
template <class Query, class Counting>
void trace_parts(const SeenBatch& seen, const Query& query, bool parallel, Counting& counting) {
  using State = QueryState<Counting>;
  const auto trace_pencil = [&](RayRange left, State& state) {
    PencilUnit& unit = state.made_unit();
    while (left.count > 0) {
      const AnsweredRays answered =
          query.pencil(seen.pencil_rays(left), left.first, unit, state.counting);
      const std::size_t end = left.first + answered.count;
      for (std::size_t i = left.first; answered.some_undecided && i < end; ++i) {
        if (query.is_undecided(i)) query.single(i, state.counting);
      }
      left.first = end;
      left.count -= answered.count;
    }
  };
  // Divided into parts, whose results have one bit per apex.
  const auto trace_bundle = [&](const RayRange& range, State& state) {
    PencilUnit& unit = state.made_unit();
    const std::size_t skipped = range.first - range.pencil->first;
    for (std::size_t i = 0; i < range.pencils; i += BundleRays::kApexes) {
      const std::span<const Pencil> pencils(range.pencil + i,
                                            std::min(range.pencils - i, BundleRays::kApexes));
      for (std::size_t done = 0; done < range.count; done += BundlePart::kOrigins) {
        const BundlePart part = seen.bundle_part(
            pencils, skipped + done, std::min(range.count - done, BundlePart::kOrigins));
        if (query.bundle(part, unit, state.bundle, state.counting)) continue;
        for (const Pencil& pencil : pencils) {
          trace_pencil({pencil.first + part.first, part.count, &pencil}, state);
        }
      }
    }
  };
  const std::optional<bvh::Streams> streams = query.structure.streams();
  const auto trace_range = [&](const RayRange& range, State& state) {
    if (range.pencils > 1) return trace_bundle(range, state);
    if (range.pencil != nullptr) return trace_pencil(range, state);
    trace_list(query, streams, range, state.counting);
  };
  const std::vector<RayRange> ranges = ranges_of(seen.batch, Query::kToward);
  tbb::enumerable_thread_specific<State> states;
  if (parallel) {
    const std::vector<RayRange> parts = seen.parts_of(ranges);
    tbb::parallel_for(std::size_t{0}, parts.size(),
                      [&](std::size_t i) { trace_range(parts[i], states.local()); });
  } else {
    for (const RayRange& range : ranges) trace_range(range, states.local());
  }
  for (const State& state : states) counting.add(state.counting);
}

std::size_t solid_bytes(const TileHierarchy& hierarchy) {
  const Solids& solids = hierarchy.solids;
  return solids.solids.capacity() * sizeof(Solid) +
         (solids.triangles.capacity() + solids.of_triangle.capacity()) * sizeof(std::uint32_t) +
         hierarchy.solid_meshlets.capacity() * sizeof(SolidMeshlet);
}

/// Describes a node or leaf and its subtree.
void describe_child(const TileHierarchy& hierarchy, TileChild child, const scenes::Bounds& box,
                    TreeQuality& tree) {
  const auto add_all = [&](const auto& block, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) tree.add_primitive(block.primitives[i]);
  };
  tree.open(box);
  switch (child.kind()) {
    case TileChild::Kind::kNode: {
      const TileNode& node = hierarchy.nodes[child.index()];
      for (std::size_t lane = 0; lane < node.count; ++lane) {
        describe_child(hierarchy, node.children[lane], node.boxes.get(lane), tree);
      }
      break;
    }
    case TileChild::Kind::kMeshlet:
      add_all(hierarchy.meshlets[child.index()], hierarchy.meshlets[child.index()].triangle_count);
      break;
    case TileChild::Kind::kSpheres:
      add_all(hierarchy.spheres[child.index()], hierarchy.spheres[child.index()].count);
      break;
    case TileChild::Kind::kCones:
      add_all(hierarchy.cones[child.index()], hierarchy.cones[child.index()].count);
      break;
  }
  tree.close();
}

}  // namespace

void TileBeam::closest_hits(const RaySource& rays, const HitSpan& hits,
                            const QueryContext& context) const {
  if (const PrimaryRays* image = rays.image()) {
    return trace(context, [&](bool parallel, auto& counting) {
      trace_tiles(*kernels_, hierarchy_, *scene_, *image, parallel, hits, counting);
    });
  }
  if (rays.batch() == nullptr || hierarchy_.empty()) {
    return TraversalAccelerator::closest_hits(rays, hits, context);
  }
  const SeenBatch seen{hierarchy_, *scene_, *pencil_kernels_, *rays.batch()};
  trace(context, [&]<class Counting>(bool parallel, Counting& counting) {
    trace_parts(seen, ClosestOfBatch<Counting>{*this, *kernels_, seen, hits}, parallel, counting);
  });
}

void TileBeam::any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                        const QueryContext& context) const {
  if (rays.batch() == nullptr || hierarchy_.empty()) {
    return TraversalAccelerator::any_hits(rays, hits, context);
  }
  const SeenBatch seen{hierarchy_, *scene_, *pencil_kernels_, *rays.batch()};
  trace(context, [&]<class Counting>(bool parallel, Counting& counting) {
    trace_parts(seen, AnyOfBatch<Counting>{*this, *kernels_, seen, hits}, parallel, counting);
  });
}

template <class Work>
void TileBeam::trace(const QueryContext& context, const Work& work) const {
  with_counting(context.counters, [&](auto& counting) {
    if (thread_count(context.threads) == 1) return work(parallel_, counting);
    on_threads(context.threads, [&] { work(true, counting); });
  });
}

std::vector<BeamPlace> TileBeam::places(const RaySource& rays) const {
  if (rays.image() != nullptr) return places_in_image(*rays.image());
  if (rays.batch() != nullptr) return places_in_batch(*rays.batch());
  return {BeamPlace{}};
}

std::vector<BeamPlace> TileBeam::places_in_image(const PrimaryRays& rays) const {
  std::vector<BeamPlace> places(rays.count());
  HitBuffer numbers(rays.width(), rays.height(), rays.samples());
  const TiledImage tiled(rays, hierarchy_.bounds);
  const VisibleBacks backs(hierarchy_, *scene_, rays.eye(), rays.count());
  const auto image = std::make_unique_for_overwrite<TileImage>();
  std::uint32_t beam = 0;
  const auto record = [&](const SampleRaster& raster, const TileView& view) {
    HandOverRecorder recorder(TileImage::kSamples);
    record_tile({hierarchy_, *scene_, rays, raster, backs}, view, *image, recorder);
    for (int y = 0; y < view.height; ++y) {
      for (const SampleRaster::Place& place : raster.places) {
        raster.for_each_of_row(
            place, numbers, view.left, view.top + y, view.width, [&](int x, std::size_t index) {
              const std::size_t at = TileImage::place(x, y);
              const auto block = static_cast<std::uint32_t>((beam * TileImage::kSamples + at) /
                                                            TileImage::kBlockSamples);
              places[index] = {way_of(*image, recorder, at), 0, beam, block};
            });
      }
    }
    ++beam;
  };
  for (int number = 0; number < tiled.tiles(); ++number) tiled.for_each_of(number, record);
  return places;
}

std::vector<BeamPlace> TileBeam::places_in_batch(const RayBatch& batch) const {
  std::vector<BeamPlace> places(batch.rays.size());
  if (hierarchy_.empty()) return places;
  RayBatch pencil_by_pencil = batch;
  pencil_by_pencil.marks = nullptr;
  const SeenBatch seen{hierarchy_, *scene_, *pencil_kernels_, pencil_by_pencil};
  const auto unit = std::make_unique_for_overwrite<PencilUnit>();
  std::uint32_t number = 0;
  for (const RayRange& part : seen.parts_of(ranges_of(pencil_by_pencil, true))) {
    if (part.pencil == nullptr) continue;
    const std::span<BeamPlace> own = std::span(places).subspan(part.first, part.count);
    pencil_kernels_->places(seen.pencil_rays(part), *unit, own);
    for (BeamPlace& place : own) {
      if (place.way == BeamPlace::Way::kSingle) continue;
      place.beam = number;
      place.block += number * kBlocksOfPart;
    }
    ++number;
  }
  return places;
}

std::vector<ParameterInfo> TileBeam::parameters() {
  const TileHierarchyOptions defaults;
  return {integer_parameter("max_leaf", defaults.max_leaf, 1, 32,
                            "maximum number of primitives in "
                            "a leaf"),
          flag_parameter("parallel", defaults.parallel,
                         "use all cores to build and to trace images and batches; the hits are the "
                         "same"),
          flag_parameter("backface_culling", defaults.backface_culling,
                         "in images, cull the backs of closed surfaces that are proven to hide "
                         "them; open surfaces are not affected"),
          choice_parameter("lists", "auto", {"auto", "streams", "single"},
                           "rays that are in no pencil: streams: traverse the hierarchy together; "
                           "single: one by one; auto: streams, unless only images are traced, "
                           "which do not need their hierarchy"),
          update_parameter(),
          isa_parameter()};
}

TileHierarchyOptions TileBeam::options_from(const Parameters& parameters,
                                            const Workload& workload) {
  TileHierarchyOptions options;
  options.max_leaf = static_cast<std::uint32_t>(parameters.integer("max_leaf"));
  options.parallel = parameters.flag("parallel");
  options.backface_culling = parameters.flag("backface_culling");
  options.moves = parameters.flag(update_parameter().name);
  if (options.moves && options.backface_culling) {
    throw InputError("tile-beam: with update=true solids may open: set backface_culling=false");
  }
  const std::string& lists = parameters.choice("lists");
  options.streams = lists == "streams" || (lists == "auto" && workload.has_lists);
  return options;
}

bool TileBeam::update(const scenes::Scene& scene) {
  if (!moves_) return false;
  scene_ = &scene;
  refit(hierarchy_, scene, parallel_);
  return true;
}

const char* TileBeam::instruction_set() const { return hwy::TargetName(kernels_->target); }

Statistics TileBeam::statistics() const {
  Statistics statistics;
  statistics.nodes = hierarchy_.nodes.size() + hierarchy_.leaves();
  statistics.leaves = hierarchy_.leaves();
  statistics.references = hierarchy_.references;
  statistics.depth = hierarchy_.depth;
  statistics.bytes = hierarchy_.bytes() + solid_bytes(hierarchy_) + hierarchy_.stream_bytes();
  statistics.instruction_set = instruction_set();
  statistics.image_rays = ImageRays::kOwn;
  statistics.more = {{"meshlets", static_cast<double>(hierarchy_.meshlets.size())},
                     {"solids", static_cast<double>(hierarchy_.solids.solids.size())},
                     {"solid_triangles", static_cast<double>(hierarchy_.solids.triangles.size())}};
  if (hierarchy_.is_refit) return statistics;
  statistics.more.emplace_back("cost", hierarchy_.cost);
  hierarchy_.visits.append_to(statistics);
  return statistics;
}

void TileBeam::describe(TreeQuality& tree) const {
  if (!hierarchy_.empty()) describe_child(hierarchy_, hierarchy_.root, hierarchy_.bounds, tree);
}

void register_tile_beam(Registry& registry) {
  registry.add(
      {"tile-beam",
       "beams the size of screen tiles through a wide hierarchy over meshlets, hits "
       "resolved by SIMD: the thesis's idea with today's methods",
       Conformance::kTolerance, TileBeam::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         return std::make_unique<TileBeam>(scene, TileBeam::options_from(parameters, workload),
                                           targets_of(parameters.choice("isa")));
       }});
  std::vector<CounterInfo> counters = bvh::stream_counters();
  counters.push_back({"beams",
                      "traced tiles of the image, and traced parts of pencils through a side "
                      "of the cube"});
  counters.push_back({"bundle_origins",
                      "ray origins tested at once against several apexes (the points of one "
                      "light)"});
  counters.push_back({"open_origins",
                      "of these: origins whose rays had to be traced apex by apex, because "
                      "their results differ"});
  registry.describe_counters("tile-beam", std::move(counters));
}

}  // namespace beambench::accel::tile_beam
