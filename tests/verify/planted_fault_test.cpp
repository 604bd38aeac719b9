// A fault planted in a structure changes the verdict, however small it is.

#include <cstdint>
#include <optional>

#include <gtest/gtest.h>

#include "accel/core/intersect.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/octree/samet.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::verify {
namespace {

/// A scene, and the level at which some leaf is the only one in which a primitive's hit is found. A
/// sphere is also found where the ray leaves it, so it needs large leaves.
struct SceneAndLevel {
  const char* scene;
  int max_level;
};

/// The fault of a `FaultySamet`. Leaves are identified by their index among the nodes.
struct SametFault {
  std::optional<std::size_t> skipped_leaf;
  std::optional<std::uint32_t> dropped_reference;  ///< index into the octree's references
};

/// Samet's structure with one fault.
class FaultySamet : public accel::TraversalAccelerator<FaultySamet> {
 public:
  FaultySamet(const scenes::Scene& scene, const accel::octree::OctreeOptions& options,
              const SametFault& fault)
      : scene_(&scene), octree_(scene, options), fault_(fault) {}

  accel::Statistics statistics() const override { return octree_.statistics(); }
  const accel::octree::Octree& octree() const { return octree_; }

  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting& counting) const {
    accel::ClosestHit closest(ray);
    const auto test_leaf = [&](const accel::octree::OctreeNode& leaf, double exit_t) {
      const auto index = static_cast<std::size_t>(&leaf - octree_.nodes().data());
      const auto references = octree_.references(leaf);
      for (std::uint32_t i = 0; i < references.size() && fault_.skipped_leaf != index; ++i) {
        if (fault_.dropped_reference != leaf.first + i) closest.test(*scene_, references[i]);
      }
      return closest.ray.t_max < static_cast<float>(exit_t);
    };
    accel::octree::walk_leaves(octree_, accel::octree::AncestorNeighbors(octree_), ray, counting,
                               test_leaf);
    return closest.result();
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting& counting) const {
    return find_closest(ray, counting).has_value();
  }

 private:
  const scenes::Scene* scene_;
  accel::octree::Octree octree_;
  SametFault fault_;
};

class PlantedFault : public ::testing::TestWithParam<SceneAndLevel> {
 protected:
  static constexpr int kSide = 96;

  PlantedFault()
      : scene_(scenes::load_scene(GetParam().scene)),
        rays_(scene_.cameras.front(), kSide, kSide, 1),
        reference_(scene_, rays_) {
    options_.max_level = GetParam().max_level;
  }

  DiffReport verify_with(const SametFault& fault) const {
    accel::HitBuffer buffer(kSide, kSide, 1);
    FaultySamet(scene_, options_, fault).closest_hits(rays_, buffer, {});
    return verify_results(reference_, buffer, accel::Conformance::kBitExact);
  }

  /// Returns the leaf in which some ray finds its hit, and the reference that is hit there.
  SametFault where_a_hit_is_found(bool whole_leaf) const {
    const FaultySamet sound(scene_, options_, {});
    const accel::octree::Octree& octree = sound.octree();
    SametFault fault;
    for (int i = 0; i < kSide * kSide; ++i) {
      const accel::Ray ray = rays_.ray(i % kSide, i / kSide, 0);
      const auto hit = sound.closest_hit(ray, nullptr);
      if (!hit) continue;
      int leaves = 0;
      accel::NoCounting none;
      const auto look_for_hit = [&](const accel::octree::OctreeNode& leaf, double) {
        const auto references = octree.references(leaf);
        for (std::uint32_t k = 0; k < references.size(); ++k) {
          if (references[k] != hit->primitive) continue;
          ++leaves;
          fault = whole_leaf
                      ? SametFault{static_cast<std::size_t>(&leaf - octree.nodes().data()), {}}
                      : SametFault{{}, leaf.first + k};
        }
        return false;
      };
      accel::octree::walk_leaves(octree, accel::octree::AncestorNeighbors(octree), ray, none,
                                 look_for_hit);
      if (leaves == 1) return fault;  // no other leaf on the path refers to the primitive
    }
    ADD_FAILURE() << "no ray finds its hit in one leaf alone";
    return fault;
  }

  scenes::Scene scene_;
  accel::octree::OctreeOptions options_;
  accel::PrimaryRays rays_;
  ReferenceHits reference_;
};

TEST_P(PlantedFault, NoneIsOk) { EXPECT_EQ(verify_with({}).verdict, Verdict::kOk); }

TEST_P(PlantedFault, OneReferenceDroppedIsAMismatch) {
  const DiffReport report = verify_with(where_a_hit_is_found(false));
  EXPECT_EQ(report.verdict, Verdict::kMismatch);
  EXPECT_GT(report.count(DiffClass::kStructureError), 0U);
}

TEST_P(PlantedFault, OneLeafSkippedIsAMismatch) {
  const DiffReport report = verify_with(where_a_hit_is_found(true));
  EXPECT_EQ(report.verdict, Verdict::kMismatch);
  EXPECT_GT(report.count(DiffClass::kStructureError), 0U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, PlantedFault,
                         ::testing::Values(SceneAndLevel{"tetra:n=4", 6},
                                           SceneAndLevel{"escena1", 3}),
                         [](const auto& info) {
                           return info.param.scene[0] == 't' ? "tetra" : "escena1";
                         });

}  // namespace
}  // namespace beambench::verify
