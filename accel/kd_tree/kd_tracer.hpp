#pragma once
// Individual rays through a kd-tree.

#include <optional>
#include <vector>

#include "accel/bvh/probe_ray.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "accel/kd_tree/kd_kernels.hpp"
#include "accel/kd_tree/kd_tree.hpp"

namespace beambench::accel::kd_tree {

/// A kd-tree, traversed in double. The primitives of a leaf are tested in blocks by SIMD in single
/// precision, as in `sah-bvh`. These tests only reject; the canonical test decides the candidates
/// that pass, so the hits equal those of every other classic structure on every instruction set.
class KdTracer : public TraversalAccelerator<KdTracer> {
 public:
  KdTracer(const scenes::Scene& scene, const KdTreeOptions& options)
      : scene_(&scene), tree_(build_kd_tree(scene, options)), kernels_(&best_kd_kernels()) {}

  const KdTree& tree() const { return tree_; }
  /// Returns Highway's name of the instruction set in use, such as "AVX2".
  const char* instruction_set() const;
  Statistics statistics() const override;
  std::vector<Cell> occupied_cells() const override;

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    if (tree_.empty()) return std::nullopt;
    if (!bvh::ProbeRay::can_probe(ray)) {
      return exhaustive::Exhaustive(*scene_).find_closest(ray, counting);
    }
    return kernels_->queries<Counting>().closest(tree_, *scene_, ray, counting);
  }

  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    if (tree_.empty()) return false;
    if (!bvh::ProbeRay::can_probe(ray)) {
      return exhaustive::Exhaustive(*scene_).find_any(ray, counting);
    }
    return kernels_->queries<Counting>().any(tree_, *scene_, ray, counting);
  }

 private:
  const scenes::Scene* scene_;
  KdTree tree_;
  const KdKernels* kernels_;
};

}  // namespace beambench::accel::kd_tree
