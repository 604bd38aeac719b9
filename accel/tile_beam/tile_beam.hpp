#pragma once
// Traces primary rays in beams the size of screen tiles, and other rays in pencils, through a
// hierarchy over meshlets.

#include "accel/bvh/probe_ray.hpp"
#include "accel/bvh/streams.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/instruction_set.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/core/tree_quality.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/tile_beam/pencil_kernels.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_kernels.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::tile_beam {

/// The thesis's two ideas, many primary rays traced through the scene as one beam and no rays in
/// empty space, with modern methods: a tile of the screen traverses a hierarchy of boxes front to
/// back, skipping boxes excluded by its frustum, its samples or nearer hits (hierarchical Z:
/// Greene, Kass and Miller 1993), and draws the contents of leaves. Images are computed in float,
/// accurate to a few roundings of the distances. So are the pencils of batches (shadow rays of a
/// point light, and rays from a planar mirror), as seen from their common point
/// (pencil_walk-inl.hpp). All other rays, single or in lists, return the hits of the classic
/// structures, bit for bit; lists are traced as streams (accel/bvh/streams.hpp).
class TileBeam : public TraversalAccelerator<TileBeam>, public BoxHierarchy {
 public:
  static std::vector<ParameterInfo> parameters();
  /// Reads the options. `workload` determines whether to expect lists of rays if `lists` is `auto`.
  static TileHierarchyOptions options_from(const Parameters& parameters, const Workload& workload);

  /// `targets`: the allowed instruction sets (accel/core/instruction_set.hpp).
  TileBeam(const scenes::Scene& scene, const TileHierarchyOptions& options,
           std::int64_t targets = targets_of("best"))
      : scene_(&scene),
        hierarchy_(build_tile_hierarchy(scene, options)),
        kernels_(&tile_kernels_for(targets)),
        pencil_kernels_(&pencil_kernels_for(targets)),
        stream_kernels_(&bvh::stream_kernels_for(targets)),
        parallel_(options.parallel),
        moves_(options.moves) {}

  /// Returns the minimum number of rays of a pencil. The rays of smaller pencils are traced singly,
  /// because the fixed cost of a part exceeds the gain. Rays toward an apex come from everywhere in
  /// the picture; those away from one see what their mirror shows, which may be in a few leaves.
  static constexpr std::size_t least_pencil(bool toward) { return toward ? 512 : 32; }

  const TileHierarchy& hierarchy() const { return hierarchy_; }
  /// Returns Highway's name of the instruction set in use, such as "AVX3".
  const char* instruction_set() const;
  Statistics statistics() const override;
  void describe(TreeQuality& tree) const override;

  /// Traces an image in tiles, and a batch with its pencils.
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override;
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override;
  std::vector<BeamPlace> places(const RaySource& rays) const override;
  /// Works only if the structure was built for a moving scene.
  bool update(const scenes::Scene& scene) override;

  /// Returns the streams that trace lists of rays; nothing if lists are traced ray by ray.
  std::optional<bvh::Streams> streams() const {
    if (hierarchy_.stream_bvh.empty()) return std::nullopt;
    return bvh::Streams{hierarchy_.stream_bvh, hierarchy_.stream_tree, *scene_, *stream_kernels_};
  }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    if (hierarchy_.empty()) return std::nullopt;
    if (!bvh::ProbeRay::can_probe(ray))
      return exhaustive::Exhaustive(*scene_).find_closest(ray, counting);
    return kernels_->queries<Counting>().closest(hierarchy_, *scene_, ray, counting);
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    if (hierarchy_.empty()) return false;
    if (!bvh::ProbeRay::can_probe(ray))
      return exhaustive::Exhaustive(*scene_).find_any(ray, counting);
    return kernels_->queries<Counting>().any(hierarchy_, *scene_, ray, counting);
  }

 private:
  /// Calls `work(parallel, counting)` on the threads of a query.
  template <class Work>
  void trace(const QueryContext& context, const Work& work) const;
  std::vector<BeamPlace> places_in_image(const PrimaryRays& rays) const;
  std::vector<BeamPlace> places_in_batch(const RayBatch& batch) const;

  const scenes::Scene* scene_;
  TileHierarchy hierarchy_;
  const TileKernels* kernels_;
  const PencilKernels* pencil_kernels_;
  const bvh::StreamKernels* stream_kernels_;
  bool parallel_;
  bool moves_;
};

}  // namespace beambench::accel::tile_beam
