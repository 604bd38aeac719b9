#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/inspector_of.hpp"
#include "accel/core/registry.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

TEST(Contract, EverySourceGetsTheSameHits) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const PrimaryRays image(scene.cameras.front(), 31, 17, 1);
  std::vector<Ray> rays;
  image.for_each(0, image.height(), [&](std::size_t, const Ray& ray) { rays.push_back(ray); });
  for (const StructureInfo& info : registry().structures()) {
    if (info.conformance != Conformance::kBitExact || !info.support.single_rays) continue;
    SCOPED_TRACE(info.name);
    const auto structure = registry().choose({info.name, {}}).build(scene);
    HitBuffer of_image(31, 17, 1);
    HitBuffer of_batch(static_cast<int>(rays.size()), 1, 1);
    std::vector<std::uint8_t> any_of_image(rays.size());
    std::vector<std::uint8_t> any_of_batch(rays.size());
    structure->closest_hits(image, of_image, {});
    structure->closest_hits(RayBatch{rays}, of_batch, {});
    structure->any_hits(image, any_of_image, {.threads = 2});
    structure->any_hits(RayBatch{rays}, any_of_batch, {});
    EXPECT_EQ(any_of_image, any_of_batch);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto hit = structure->closest_hit(rays[i]);
      ASSERT_EQ(of_image.get(i), hit) << i;
      ASSERT_EQ(of_batch.get(i), hit) << i;
      ASSERT_EQ(any_of_image[i] != 0, hit.has_value()) << i;
      ASSERT_EQ(structure->any_hit(rays[i]), hit.has_value()) << i;
    }
  }
}

TEST(Contract, UnsupportedRaysAreRefused) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const std::vector<Ray> rays(2);
  std::vector<std::uint8_t> any(rays.size());
  for (const StructureInfo& info : registry().structures()) {
    SCOPED_TRACE(info.name);
    const auto structure = registry().choose({info.name, {}}).build(scene);
    if (!info.support.single_rays) {
      EXPECT_THROW(structure->closest_hit(rays[0]), UnsupportedError);
      EXPECT_THROW(structure->any_hit(rays[0]), UnsupportedError);
    }
    if (!info.support.batches) {
      HitBuffer hits(2, 1, 1);
      EXPECT_THROW(structure->closest_hits(RayBatch{rays}, hits, {}), UnsupportedError);
      EXPECT_THROW(structure->any_hits(RayBatch{rays}, any, {}), UnsupportedError);
    }
  }
}

TEST(Contract, ASourceStatesItsSize) {
  const Ray ray;
  const PrimaryRays image(scenes::Camera{}, 5, 4, 1);
  const std::vector<Ray> three(3);
  EXPECT_EQ(RaySource(ray).size(), 1U);
  EXPECT_EQ(RaySource(image).size(), 20U);
  EXPECT_EQ(RaySource(RayBatch{three}).size(), 3U);
}

TEST(Contract, AWrapperForwardsWhatItDoesNotOverride) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const auto samet = registry().choose({"samet", {}}).build(scene);
  const ForwardingAccelerator wrapper(*samet);
  const Ray ray = PrimaryRays(scene.cameras.front(), 9, 9, 1).ray(4, 4, 0);
  EXPECT_EQ(wrapper.closest_hit(ray), samet->closest_hit(ray));
  EXPECT_EQ(wrapper.statistics().nodes, samet->statistics().nodes);
  EXPECT_EQ(wrapper.inspector(), samet->inspector());
}

TEST(Contract, UnsupportedPrimitivesAreRefusedBeforeTheBuild) {
  StructureInfo info{"triangles",
                     "takes polygons only",
                     Conformance::kBitExact,
                     {},
                     [](const scenes::Scene&, const Parameters&,
                        const Workload&) -> std::unique_ptr<Accelerator> { return nullptr; }};
  info.support = {.spheres = false, .cones = false};
  const StructureChoice choice(info, Parameters(info.name, info.parameters, {}));
  EXPECT_THROW(choice.build(scenes::load_scene("balls:n=1")), UnsupportedError);
  EXPECT_EQ(choice.build(scenes::load_scene("tetra:n=2")), nullptr);
}

TEST(Contract, AnInspectorIsOptional) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const auto embree = registry().choose({"embree", {}}).build(scene);
  EXPECT_EQ(embree->inspector(), nullptr);
  EXPECT_TRUE(inspector_of(*embree).path(Ray{}).empty());
  EXPECT_FALSE(embree->update(scene));
}

}  // namespace
}  // namespace beambench::accel
