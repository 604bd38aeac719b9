// The beams of one sample: they contain the image's samples, and the hit is the same.

#include "accel/beam/sample_path.hpp"

#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"

namespace beambench::accel {
namespace {

beam::BeamOptions options_of_level(int level) {
  beam::BeamOptions options;
  options.octree.max_level = level;
  return options;
}

/// Identifies a beam in a leaf by its kind, the leaf and the outline.
using Name = std::tuple<BeamKind, std::uint32_t, std::vector<std::pair<double, double>>>;

Name name_of(const BeamPassage& passage) {
  std::vector<std::pair<double, double>> corners;
  for (const glm::dvec2& corner : passage.corners) corners.emplace_back(corner.x, corner.y);
  return {passage.kind, passage.node, std::move(corners)};
}

struct Case {
  const char* scene;
  beam::BeamOptions options;
  int samples;
};

std::vector<Case> cases() {
  std::vector<Case> all{{"tetra:n=4", options_of_level(5), 1},
                        {"escena1", options_of_level(5), 1},
                        {"escena2", options_of_level(5), 5},
                        {"closed-room:detail=1", options_of_level(5), 1}};
  all.push_back({"escena1", options_of_level(5), 1});
  all.back().options.handover = 30;
  all.push_back({"escena1", options_of_level(5), 1});
  all.back().options.continue_with_rays = false;
  all.push_back({"tetra:n=3", options_of_level(4), 5});
  all.back().options.share_corners = true;
  return all;
}

class SamplePaths : public ::testing::TestWithParam<Case> {};

TEST_P(SamplePaths, HaveTheImagesHitsAndEndWithTheBeam) {
  const scenes::Scene scene = scenes::load_scene(GetParam().scene);
  const beam::BeamOptions& options = GetParam().options;
  const beam::BeamTracer tracer(scene, options);
  const PrimaryRays rays(scene.cameras.front(), 10, 8, GetParam().samples);
  HitBuffer hits(10, 8, GetParam().samples);
  tracer.closest_hits(rays, hits, {});
  const bool shared = options.share_corners;
  std::map<Name, std::pair<std::uint64_t, std::uint64_t>> samples;  // expected, found
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 10; ++x) {
      for (int sample = 0; sample < GetParam().samples; ++sample) {
        SCOPED_TRACE(::testing::Message() << x << "," << y << " sample " << sample);
        const beam::SamplePath path = beam::path_of_sample(tracer, rays, x, y, sample);
        ASSERT_EQ(path.hit, hits.get(hits.index(x, y, sample)));
        const Ray ray = rays.ray(x, y, sample);
        const std::vector<TraceStep> alone = tracer.path(ray);
        if (alone.empty()) {
          EXPECT_TRUE(path.beams.empty());
          continue;
        }
        ASSERT_FALSE(path.beams.empty());
        for (std::size_t i = 0; i < path.beams.size(); ++i) {
          const BeamPassage& beam = path.beams[i];
          ++samples[name_of(beam)].second;
          samples[name_of(beam)].first = beam.samples;
          if (beam.kind == BeamKind::kLeaving) {
            EXPECT_EQ(i + 1, path.beams.size());
            EXPECT_TRUE(path.steps.empty() || !options.continue_with_rays);
            continue;
          }
          // The leaves of the ray's own path while it is in beams.
          ASSERT_LT(i, alone.size());
          EXPECT_EQ(beam.node, alone[i].index);
          EXPECT_EQ(beam.level, alone[i].level);
          const bool last = i + 1 == path.beams.size();
          EXPECT_EQ(beam.kind == BeamKind::kOccupied, !alone[i].tests.empty());
          if (options.handover == 0 && options.continue_with_rays) {
            EXPECT_EQ(last, beam.kind == BeamKind::kOccupied);
          }
        }
        if (path.beams.back().kind == BeamKind::kOccupied && options.continue_with_rays) {
          ASSERT_FALSE(path.steps.empty());
          EXPECT_EQ(path.steps.front().index, path.beams.back().node);
          EXPECT_EQ(path.reason.has_value(), path.steps.size() > 1 || !path.hit);
        }
      }
    }
  }
  EXPECT_FALSE(samples.empty());
  for (const auto& [name, counts] : samples) {
    if (shared) continue;  // a corner is one sample of the beam but belongs to four pixels
    EXPECT_EQ(counts.first, counts.second) << "leaf " << std::get<1>(name);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SamplePaths, ::testing::ValuesIn(cases()));

// A beam that continues undivided has no new cut and the same outline; a divided one has both.
TEST(SamplePath, NamesTheCutsOfADividedBeamOnly) {
  const scenes::Scene scene = scenes::load_scene("escena2");
  const beam::BeamTracer tracer(scene, options_of_level(6));
  const PrimaryRays rays(scene.cameras.front(), 16, 12, 1);
  int whole = 0;
  int divided = 0;
  for (int x = 0; x < 16; ++x) {
    const beam::SamplePath path = beam::path_of_sample(tracer, rays, x, 6, 0);
    for (std::size_t i = 1; i < path.beams.size(); ++i) {
      const bool is_same = path.beams[i].corners == path.beams[i - 1].corners;
      EXPECT_EQ(path.beams[i].cuts.empty(), is_same);
      ++(is_same ? whole : divided);
      EXPECT_LE(path.beams[i].samples, path.beams[i - 1].samples);
      for (const PlaneOrder& cut : path.beams[i].cuts) {
        EXPECT_TRUE(cut.first.axis != cut.second.axis || cut.first.at != cut.second.at);
      }
    }
  }
  EXPECT_GT(whole, 0);
  EXPECT_GT(divided, 0);
}

}  // namespace
}  // namespace beambench::accel
