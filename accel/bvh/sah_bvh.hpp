#pragma once
// Individual rays through the modern standard structure: an eight-wide SAH hierarchy.

#include "accel/bvh/probe_ray.hpp"
#include "accel/bvh/sah_kernels.hpp"
#include "accel/bvh/stream_tree.hpp"
#include "accel/bvh/streams.hpp"
#include "accel/bvh/wide_bvh.hpp"
#include "accel/core/instruction_set.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/core/tree_quality.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::bvh {

struct SahBvhOptions : WideBvhOptions {
  bool streams = true;  ///< trace lists of rays as streams (stream_walk-inl.hpp)
};

/// A SAH hierarchy with eight children per node, traversed by SIMD in single precision (Wald,
/// Benthin and Boulos, "Getting rid of packets", 2008). The float tests only reject; the canonical
/// test decides the candidates that pass, so the hits equal those of every other classic structure
/// on every instruction set.
class SahBvh : public TraversalAccelerator<SahBvh>, public BoxHierarchy {
 public:
  static std::vector<ParameterInfo> parameters();
  static SahBvhOptions options_from(const Parameters& parameters);

  /// `targets`: the allowed instruction sets (accel/core/instruction_set.hpp).
  SahBvh(const scenes::Scene& scene, const SahBvhOptions& options,
         std::int64_t targets = targets_of("best"));

  const WideBvh& bvh() const { return bvh_; }
  /// Returns Highway's name of the instruction set in use, such as "AVX2".
  const char* instruction_set() const;
  Statistics statistics() const override;
  void describe(TreeQuality& tree) const override;
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override;
  void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                const QueryContext& context) const override;
  bool update(const scenes::Scene& scene) override;

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    if (bvh_.empty()) return std::nullopt;
    if (!ProbeRay::can_probe(ray))
      return exhaustive::Exhaustive(*scene_).find_closest(ray, counting);
    return kernels_->queries<Counting>().closest(bvh_, *scene_, ray, counting);
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    if (bvh_.empty()) return false;
    if (!ProbeRay::can_probe(ray)) return exhaustive::Exhaustive(*scene_).find_any(ray, counting);
    return kernels_->queries<Counting>().any(bvh_, *scene_, ray, counting);
  }

 private:
  void describe(ChildReference child, const scenes::Bounds& box, TreeQuality& tree) const;

  bool is_stream(const RaySource& rays) const {
    return streams_ && rays.batch() != nullptr && rays.size() >= Streams::kLeast && !bvh_.empty();
  }
  Streams streams() const { return {bvh_, stream_tree_, *scene_, *stream_kernels_}; }

  const scenes::Scene* scene_;
  WideBvh bvh_;
  bool streams_;
  bool parallel_;
  StreamTree stream_tree_;
  const SahKernels* kernels_;
  const StreamKernels* stream_kernels_;
};

}  // namespace beambench::accel::bvh
