// The pencils of whole pictures: all rays of a pencil pass through its apex, and results do not
// depend on pencils.

#include "harness/render/pencils.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "harness/rays/counted_queries.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/render/verified_picture.hpp"
#include "harness/render/whitted_picture.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"
#include "tests/pencils.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

/// Forwards batches without their marks.
class Unmarked : public accel::ForwardingAccelerator {
 public:
  using ForwardingAccelerator::ForwardingAccelerator;

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    if (rays.batch() == nullptr) return structure().closest_hits(rays, hits, context);
    structure().closest_hits(accel::RayBatch{rays.batch()->rays}, hits, context);
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    if (rays.batch() == nullptr) return structure().any_hits(rays, hits, context);
    structure().any_hits(accel::RayBatch{rays.batch()->rays}, hits, context);
  }
};

/// Checks the marked rays, and forwards batches without their marks.
class Checked : public Unmarked {
 public:
  Checked(const accel::Accelerator& structure, tests::CheckedPencils& pencils)
      : Unmarked(structure), pencils_(&pencils) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    if (rays.batch() != nullptr) add(*rays.batch());
    Unmarked::closest_hits(rays, hits, context);
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    if (rays.batch() != nullptr) add(*rays.batch());
    Unmarked::any_hits(rays, hits, context);
  }

 private:
  void add(const accel::RayBatch& batch) const {
    EXPECT_EQ(batch.samples.size(), batch.rays.size());
    EXPECT_NE(batch.image, nullptr);
    for (const accel::Pencil& pencil : batch.pencils) EXPECT_GE(pencil.count, kMinPencil);
    pencils_->add(batch);
  }
  tests::CheckedPencils* pencils_;
};

RecordedPicture recorded(const scenes::Scene& scene, const accel::Accelerator& structure,
                         const accel::PrimaryRays& image, const WhittedOptions& options = {}) {
  accel::HitBuffer hits(image.width(), image.height(), image.samples());
  built(scene, "sah-bvh")->closest_hits(image, hits, {});
  return record_picture(std::make_shared<const ShadedScene>(scene), structure, image,
                        std::move(hits), options, rays::HitCheck(scene));
}

/// Returns a room of planar mirrors containing a ball, rotated relative to the axes.
scenes::Scene mirror_room() {
  scenes::SceneBuilder builder = with_light({0.3, 0.2, 0.4});
  builder.set_surface({.diffuse = 0.3F, .specular = 0.7F});
  const dvec3 axes[] = {glm::normalize(dvec3(2.0, 1.0, 0.5)), {}, {}};
  const dvec3 v = glm::normalize(glm::cross(axes[0], dvec3(0.0, 0.0, 1.0)));
  const dvec3 w = glm::cross(axes[0], v);
  const dvec3 turned[] = {axes[0], v, w};
  for (int axis = 0; axis < 3; ++axis) {
    const dvec3 a = turned[(axis + 1) % 3];
    const dvec3 b = turned[(axis + 2) % 3];
    for (const double side : {-1.0, 1.0}) {
      const dvec3 middle = side * turned[axis];
      const dvec3 corners[] = {middle - a - b, middle + a - b, middle + a + b, middle - a + b};
      builder.add_polygon(std::span(corners).first(3));
      const dvec3 others[] = {corners[0], corners[2], corners[3]};
      builder.add_polygon(others);
    }
  }
  builder.set_surface({.color = {0.9F, 0.5F, 0.2F}, .diffuse = 0.8F});
  builder.add_sphere({0.3, -0.2, -0.3}, 0.25);
  scenes::Camera camera;
  camera.from = {-0.4F, 0.3F, 0.1F};
  camera.at = {0.3F, -0.2F, -0.3F};
  camera.angle = 60.0F;
  builder.add_camera(camera);
  return std::move(builder).build();
}

void expect_same(const AskedRays& a, const AskedRays& b) {
  EXPECT_EQ(rays::fingerprint(a.closest), rays::fingerprint(b.closest));
  EXPECT_TRUE(a.hits == b.hits);
  EXPECT_EQ(rays::fingerprint(a.any), rays::fingerprint(b.any));
  EXPECT_TRUE(a.any_hits == b.any_hits);
}

TEST(Pencils, PassThroughTheirApexInTheCatalogue) {
  for (const char* name : {"teapot:n=3", "gears:n=2", "habitacion", "ajedrez", "finishes", "misil",
                           "gato-bill", "closed-room", "casa-de-campo", "balls:n=2"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const accel::PrimaryRays image(scene.cameras.front(), 120, 90, 1);
    tests::CheckedPencils pencils(scene, image, 16.0);
    const auto structure = built(scene, "sah-bvh");
    recorded(scene, Checked(*structure, pencils), image);
    EXPECT_GT(pencils.toward, 0U);
  }
}

TEST(Pencils, PassThroughTheirApexInRandomScenes) {
  std::size_t toward = 0, away = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = scene_of_all_surfaces(seed);
    const accel::PrimaryRays image(scene.cameras.front(), 80, 60, seed % 3 == 0 ? 4 : 1);
    tests::CheckedPencils pencils(scene, image, 16.0);
    const auto structure = built(scene, "sah-bvh");
    recorded(scene, Checked(*structure, pencils), image);
    toward += pencils.toward;
    away += pencils.away;
  }
  EXPECT_GT(toward, 10'000U);
  EXPECT_GT(away, 1'000U);
}

// If all mirrors are planar, almost all rays come from virtual eyes, however often they are
// reflected.
TEST(Pencils, AreOfAnyDepth) {
  const scenes::Scene scene = mirror_room();
  const accel::PrimaryRays image(scene.cameras.front(), 128, 128, 1);
  tests::CheckedPencils pencils(scene, image, 16.0);
  const auto structure = built(scene, "sah-bvh");
  const RecordedPicture picture = recorded(scene, Checked(*structure, pencils), image);
  EXPECT_GT(picture.census.reflected, 3U * 128 * 128);
  EXPECT_GT(static_cast<double>(pencils.away), 0.9 * static_cast<double>(picture.census.reflected));
  EXPECT_GT(static_cast<double>(pencils.toward), 0.9 * static_cast<double>(picture.census.shadow));
}

// Exactly the rays that planar glass refracts are marked, even behind several planes of glass.
TEST(RefractedRays, AreThoseBehindPlanarGlass) {
  class Counted : public Unmarked {
   public:
    using Unmarked::Unmarked;
    void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                      const accel::QueryContext& context) const override {
      if (rays.batch() != nullptr && rays.batch()->marks != nullptr) {
        std::size_t end = 0;
        for (const accel::RefractedRays& each : rays.batch()->marks->refracted) {
          EXPECT_GE(each.first, end);
          EXPECT_GE(each.count, kMinRefracted);
          end = each.first + each.count;
          marked += each.count;
        }
        EXPECT_LE(end, rays.batch()->rays.size());
      }
      Unmarked::closest_hits(rays, hits, context);
    }
    mutable std::size_t marked = 0;
  };
  for (const auto& [name, least] :
       {std::pair("aquarium:detail=1", 0.9), {"prism:detail=1", 0.9}, {"balls:n=2", 0.0}}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    const accel::PrimaryRays image(scene.cameras.front(), 160, 120, 1);
    const auto structure = built(scene, "sah-bvh");
    const Counted counted(*structure);
    const RecordedPicture picture = recorded(scene, counted, image);
    const auto refracted = static_cast<double>(picture.census.refracted);
    EXPECT_GE(static_cast<double>(counted.marked), least * refracted);
    EXPECT_EQ(counted.marked == 0, least == 0.0);
  }
}

TEST(Pencils, AreNotMadeForCurvedMirrors) {
  const scenes::Scene scene = scenes::load_scene("balls:n=2");
  const accel::PrimaryRays image(scene.cameras.front(), 120, 90, 1);
  tests::CheckedPencils pencils(scene, image, 16.0);
  const auto structure = built(scene, "sah-bvh");
  EXPECT_GT(recorded(scene, Checked(*structure, pencils), image).census.reflected, 1000U);
  EXPECT_EQ(pencils.away, 0U);
}

// Rounding decides which side of such a mirror is seen.
TEST(Pencils, AreNotMadeForMirrorsSeenEdgeOn) {
  const scenes::PlanarSurface mirror{
      {0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}, {0}, {{-4.0F, -4.0F, 1.0F}, {4.0F, 4.0F, 1.0F}}};
  const double lift = accel::mirror_lift(mirror.bounds);
  const auto behind = [&](float height) {
    scenes::Camera camera;
    camera.from = {5.0F, 0.0F, height};
    return rays::VirtualEye(accel::PrimaryRays(camera, 1, 1, 1)).behind(mirror);
  };
  EXPECT_FALSE(behind(1.0F));
  EXPECT_FALSE(behind(1.0001F));
  ASSERT_TRUE(behind(1.5F));
  EXPECT_EQ(behind(1.5F)->place, dvec3(5.0, 0.0, 0.5 + lift));
  EXPECT_EQ(behind(0.5F)->place, dvec3(5.0, 0.0, 1.5 - lift));
}

// A bit-exact structure that uses the marks finds the same hits, so the subsequent rays are the
// same.
TEST(Pencils, ChangeNothingThatAPictureDependsOn) {
  std::vector<scenes::Scene> all;
  all.push_back(mirror_room());
  for (const char* name : {"teapot:n=3", "aquarium:detail=2", "prism:detail=2", "gears:n=1"}) {
    all.push_back(scenes::load_scene(name));
  }
  for (std::uint64_t seed = 1; seed <= 4; ++seed) all.push_back(scene_of_all_surfaces(seed));
  for (const scenes::Scene& scene : all) {
    SCOPED_TRACE(scene.name);
    const accel::PrimaryRays image(scene.cameras.front(), 100, 70, 1);
    for (const char* spec : {"sah-bvh", "beam"}) {
      const auto structure = built(scene, spec);
      const RecordedPicture marked = recorded(scene, *structure, image);
      const RecordedPicture unmarked = recorded(scene, Unmarked(*structure), image);
      expect_same_bits(marked.image, unmarked.image);
      EXPECT_EQ(marked.census, unmarked.census);
      for (std::size_t i = 0; i < kFollowingRays; ++i) {
        expect_same(marked.asked[i], unmarked.asked[i]);
      }
    }
  }
}

/// A structure's picture, and the work for the rays after the camera rays.
struct Worked {
  WhittedPicture picture;
  std::map<std::string, std::uint64_t, std::less<>> work;
};

Worked drawn(const scenes::Scene& scene, const char* spec, const WhittedOptions& options) {
  const auto structure = built(scene, spec);
  const accel::PrimaryRays image(scene.cameras.front(), 100, 70, 1);
  accel::HitBuffer hits(100, 70, 1);
  structure->closest_hits(image, hits, {});
  const rays::CountedQueries counted(*structure);
  const Whitted tracer(scene, counted, options);
  WhittedPicture picture = whitted_picture(tracer, image, hits, {}, 1);
  return {std::move(picture), counted.work().counters.by_name()};
}

// The thesis's beams, reflected by mirrors seen in mirrors, give the picture of single rays, bit
// for bit.
TEST(Pencils, AreBeamsOfAnyDepth) {
  const scenes::Scene scene = mirror_room();
  std::uint64_t beams_before = 0;
  for (int depth = 1; depth <= 5; ++depth) {
    SCOPED_TRACE(depth);
    const WhittedOptions options{.max_depth = depth};
    const Worked beams = drawn(scene, "beam", options);
    const Worked single = drawn(scene, "samet", options);
    expect_same_bits(beams.picture.image, single.picture.image);
    EXPECT_EQ(beams.picture.census, single.picture.census);
    const std::uint64_t count = beams.work.contains("beams") ? beams.work.at("beams") : 0;
    EXPECT_EQ(count > beams_before, depth > 1) << count << " beams, before " << beams_before;
    beams_before = count;
    EXPECT_FALSE(single.work.contains("beams"));
  }
}

/// Returns the number of pixels whose difference is visible.
int visibly_different(const Image& a, const Image& b) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const glm::vec3 apart = glm::abs(a.at(x, y) - b.at(x, y));
      count += std::max({apart.x, apart.y, apart.z}) > 1.0F / 255.0F ? 1 : 0;
    }
  }
  return count;
}

// If hits of pencils are correct only within a tolerance, the rays that follow them differ, so each
// picture is verified with its own rays. The pictures differ in a few places where rays graze
// edges.
TEST(Pencils, OfTolerantStructuresGiveTheSamePictureExceptForGrazes) {
  std::vector<scenes::Scene> all;
  all.push_back(mirror_room());
  for (const char* name : {"teapot:n=3", "closed-room", "casa-de-campo"}) {
    all.push_back(scenes::load_scene(name));
  }
  for (std::uint64_t seed = 1; seed <= 4; ++seed) all.push_back(scene_of_all_surfaces(seed));
  int scenes_with_beams = 0;
  for (const scenes::Scene& scene : all) {
    SCOPED_TRACE(scene.name);
    const accel::PrimaryRays image(scene.cameras.front(), 100, 70, 1);
    const auto structure = built(scene, "tile-beam");
    const rays::CountedQueries counted(*structure);
    const RecordedPicture marked = recorded(scene, counted, image);
    const RecordedPicture unmarked = recorded(scene, Unmarked(*structure), image);
    scenes_with_beams += counted.work().counters.by_name().contains("beams") ? 1 : 0;
    const int different = visibly_different(marked.image, unmarked.image);
    EXPECT_LE(different, 2);  // the differ's budget for so few rays
    const verify::ReferenceHits primary(scene, image);
    for (const RecordedPicture& picture : {marked, unmarked}) {
      const auto verified =
          verify_recorded_picture(primary, picture, accel::Conformance::kTolerance);
      for (const std::string& wrong : described_examples(scene, verified)) ADD_FAILURE() << wrong;
      EXPECT_EQ(sum_of(verified).verdict, verify::Verdict::kOk);
    }
  }
  EXPECT_GE(scenes_with_beams, 6);
}

// The order in which a sample's light is summed does not change either.
TEST(Pencils, DoNotChangeAPictureOfManySamples) {
  const scenes::Scene scene = mirror_room();
  const auto structure = built(scene, "sah-bvh");
  const accel::PrimaryRays image(scene.cameras.front(), 70, 50, 4);
  accel::HitBuffer hits(70, 50, 4);
  structure->closest_hits(image, hits, {});
  const Whitted tracer(scene, *structure, {});
  const WhittedPicture expected = whitted_picture(tracer, image, hits);
  Whitted::Progress progress = tracer.begin();
  Image alone(70, 50);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 70; ++x) {
      dvec3 sum(0.0);
      for (int i = 0; i < 4; ++i) {
        const accel::Ray ray = image.ray(x, y, i);
        const auto sample = static_cast<std::uint32_t>(hits.index(x, y, i));
        const std::optional<accel::Hit> hit = hits.get(sample);
        dvec3 color;
        tracer.trace_light({&image, {&ray, 1}, {&sample, 1}, {&hit, 1}}, {&color, 1}, progress);
        sum += color;
      }
      alone.at(x, y) = glm::vec3(0.25 * sum);
    }
  }
  expect_same_bits(alone, expected.image);
  EXPECT_EQ(progress.census, expected.census);
}

}  // namespace
}  // namespace beambench::render
