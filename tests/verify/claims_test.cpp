// Hits that a program reports, in every form: correct ones pass, planted faults are found, and
// impossible ones are refused.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "harness/verify/claim_verifier.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "harness/verify/tolerance.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::verify {
namespace {

using rays::ClaimedHits;
using rays::HitTable;

/// A scene, rays, and the correct hits in every form.
struct Traced {
  explicit Traced(scenes::Scene s) : scene(std::move(s)) {
    Random random(7);
    const accel::PrimaryRays image(scene.cameras.front(), 40, 30, 1);
    image.for_each(0, 30, [&](std::size_t, const accel::Ray& ray) { rays.push_back(ray); });
    for (const accel::Ray& ray : random_rays(scene, 300, random)) {
      if (!is_edge_on(scene, ray)) rays.push_back(ray);
    }
    const accel::exhaustive::Exhaustive exhaustive(scene);
    for (const accel::Ray& ray : rays) {
      const auto hit = exhaustive.closest_hit(ray, nullptr);
      const float t = hit ? hit->t : accel::kInfinity;
      hits.t.push_back(t);
      hits.primitives.push_back(hit ? hit->primitive : scenes::kNoPrimitive);
      hits.points.push_back(
          hit ? glm::vec3(glm::dvec3(ray.origin) + double{t} * glm::dvec3(ray.direction))
              : glm::vec3(accel::kInfinity));
      hits.triangles.push_back(hit ? triangle_at(*hit) : scenes::kNoPrimitive);
      hits.occluded.push_back(hit ? 1 : 0);
    }
  }

  /// Returns any triangle of the polygon that is hit.
  std::uint32_t triangle_at(const accel::Hit& hit) const {
    const scenes::Primitive& primitive = scene.primitives[hit.primitive];
    if (primitive.kind != scenes::PrimitiveKind::kPolygon) return scenes::kNoPrimitive;
    return scene.polygons[primitive.index].first_triangle;
  }

  DiffReport verify(const ClaimedHits& claims) const {
    ClaimVerifier verifier(scene);
    verifier.add(rays, claims);
    return verifier.finish();
  }

  scenes::Scene scene;
  std::vector<accel::Ray> rays;
  HitTable hits;
};

/// A form in which hits are reported.
struct Form {
  std::string name;
  std::function<ClaimedHits(const HitTable&)> claims;
  bool any = false;
};

const std::vector<Form>& forms() {
  static const std::vector<Form> kForms{
      {"t, primitive",
       [](const HitTable& h) { return ClaimedHits{.t = h.t, .primitives = h.primitives}; }},
      {"t, triangle",
       [](const HitTable& h) { return ClaimedHits{.t = h.t, .triangles = h.triangles}; }},
      {"t", [](const HitTable& h) { return ClaimedHits{.t = h.t}; }},
      {"point, primitive",
       [](const HitTable& h) {
         return ClaimedHits{.points = h.points, .primitives = h.primitives};
       }},
      {"point, triangle",
       [](const HitTable& h) { return ClaimedHits{.points = h.points, .triangles = h.triangles}; }},
      {"point", [](const HitTable& h) { return ClaimedHits{.points = h.points}; }},
      {"occluded", [](const HitTable& h) { return ClaimedHits{.occluded = h.occluded}; }, true}};
  return kForms;
}

bool names_triangles(const Form& form) { return form.name.find("triangle") != std::string::npos; }
bool names_ids(const Form& form) { return form.name.find(',') != std::string::npos; }

TEST(Claims, CorrectHitsPassInEveryForm) {
  for (const char* name : {"teapot:n=3", "gears:n=2", "balls:n=2", "tree:n=3", "tetra:n=3"}) {
    const Traced traced(scenes::load_scene(name));
    for (const Form& form : forms()) {
      if (names_triangles(form) && traced.scene.polygons.size() != traced.scene.primitives.size()) {
        continue;
      }
      const DiffReport report = traced.verify(form.claims(traced.hits));
      EXPECT_EQ(report.count(DiffClass::kStructureError), 0U) << name << ", " << form.name;
      // Rays aimed at edges graze, whatever the form of the hits.
      EXPECT_LE(report.count(DiffClass::kGraze), 20U) << name << ", " << form.name;
      EXPECT_EQ(report.rays, traced.rays.size());
      EXPECT_GT(report.hits, 100U);
    }
  }
}

/// Returns a ray that hits a face steeply and far from its edges, where a fault can be neither a
/// graze nor a tie.
std::size_t clear_hit(const Traced& traced) {
  for (std::size_t i = 0; i < traced.rays.size(); ++i) {
    if (traced.hits.primitives[i] == scenes::kNoPrimitive) continue;
    const accel::Ray& ray = traced.rays[i];
    const Contact found = contact(traced.scene, ray, {traced.hits.t[i], traced.hits.primitives[i]});
    const bool inside = boundary_distance(traced.scene, ray, traced.hits.primitives[i]) > 0.01;
    if (found.cosine > 0.5 && inside) return i;
  }
  ADD_FAILURE() << "no ray hits clearly";
  return 0;
}

void expect_found(const Traced& traced, const HitTable& wrong, const Form& form, std::size_t ray,
                  const char* fault) {
  const DiffReport report = traced.verify(form.claims(wrong));
  ASSERT_EQ(report.count(DiffClass::kStructureError), 1U) << form.name << ", " << fault;
  EXPECT_EQ(report.examples.front().index, ray) << form.name << ", " << fault;
  EXPECT_EQ(report.verdict, Verdict::kMismatch) << form.name << ", " << fault;
}

TEST(Claims, PlantedFaultsAreFoundInEveryForm) {
  const Traced traced(scenes::load_scene("tetra:n=3"));
  const std::size_t i = clear_hit(traced);
  const accel::Ray& ray = traced.rays[i];
  const double length = glm::length(glm::dvec3(ray.direction));
  const double step = 10.0 * tolerance(ray, traced.hits.t[i]);
  for (const Form& form : forms()) {
    HitTable moved = traced.hits;
    moved.t[i] += static_cast<float>(step / length);
    moved.points[i] += static_cast<float>(step / length) * ray.direction;
    if (!form.any) expect_found(traced, moved, form, i, "moved along the ray");
    HitTable beside = traced.hits;
    beside.points[i].x += static_cast<float>(step);
    beside.points[i].y += static_cast<float>(step);
    beside.points[i].z += static_cast<float>(step);
    if (form.name.starts_with("point")) expect_found(traced, beside, form, i, "moved aside");
    HitTable exchanged = traced.hits;
    exchanged.primitives[i] = (exchanged.primitives[i] + 5) % 64;
    exchanged.triangles[i] = (exchanged.triangles[i] + 5) % 64;
    if (names_ids(form)) expect_found(traced, exchanged, form, i, "exchanged id");
    HitTable lost = traced.hits;
    lost.t[i] = accel::kInfinity;
    lost.points[i] = glm::vec3(accel::kInfinity);
    lost.primitives[i] = lost.triangles[i] = scenes::kNoPrimitive;
    lost.occluded[i] = 0;
    expect_found(traced, lost, form, i, "left out");
  }
}

TEST(Claims, AnInventedHitIsFound) {
  const Traced traced(scenes::load_scene("tetra:n=3"));
  std::size_t miss = 0;
  while (traced.hits.occluded[miss] != 0) ++miss;
  HitTable wrong = traced.hits;
  wrong.t[miss] = 1.0F;
  wrong.points[miss] = traced.rays[miss].origin + traced.rays[miss].direction;
  wrong.primitives[miss] = wrong.triangles[miss] = 3;
  wrong.occluded[miss] = 1;
  for (const Form& form : forms()) expect_found(traced, wrong, form, miss, "an extra hit");
}

TEST(Claims, ManyWrongPointsCostNoMoreThanTheBudget) {
  const Traced traced(scenes::load_scene("tetra:n=3"));
  HitTable wrong = traced.hits;
  std::size_t hits = 0;
  for (float& t : wrong.t) {
    if (t == accel::kInfinity) continue;
    t *= 0.5F;
    ++hits;
  }
  const DiffReport report = traced.verify({.t = wrong.t});
  EXPECT_GT(report.count(DiffClass::kStructureError), hits * 3 / 4);
  EXPECT_GE(report.examples.size(), DiffReport::kMaxExamples);
  EXPECT_EQ(report.examples.front().reason, "there is no surface at this place");
}

TEST(Claims, PartsAddUpToTheWhole) {
  const Traced traced(scenes::load_scene("gears:n=2"));
  HitTable wrong = traced.hits;
  for (const std::size_t i : {3U, 700U, 1201U}) wrong.t[i] *= 0.9F;
  const ClaimedHits claims{.t = wrong.t, .primitives = wrong.primitives};
  const DiffReport whole = traced.verify(claims);
  ASSERT_GT(whole.count(DiffClass::kStructureError), 0U);

  ClaimVerifier verifier(traced.scene);
  std::vector<DiffClass> classes(traced.rays.size());
  std::vector<std::size_t> observed;
  ClaimVerifier watched(traced.scene,
                        [&](const Mismatch& mismatch) { observed.push_back(mismatch.index); });
  for (std::size_t first = 0; first < traced.rays.size();) {
    const std::size_t count = std::min<std::size_t>(1 + first / 2, traced.rays.size() - first);
    const auto rays = std::span(traced.rays).subspan(first, count);
    const ClaimedHits part{.t = claims.t.subspan(first, count),
                           .primitives = claims.primitives.subspan(first, count)};
    verifier.add(rays, part, std::span(classes).subspan(first, count));
    watched.add(rays, part);
    first += count;
  }
  const DiffReport parts = verifier.finish();
  EXPECT_EQ(parts.counts, whole.counts);
  EXPECT_EQ(parts.rays, whole.rays);
  EXPECT_EQ(parts.hits, whole.hits);
  EXPECT_EQ(parts.verdict, whole.verdict);
  ASSERT_EQ(parts.examples.size(), whole.examples.size());
  for (std::size_t i = 0; i < parts.examples.size(); ++i) {
    EXPECT_EQ(parts.examples[i].index, whole.examples[i].index);
    EXPECT_EQ(classes[parts.examples[i].index], parts.examples[i].diff_class);
  }
  EXPECT_EQ(observed.size(), whole.rays - whole.count(DiffClass::kAgree));
}

TEST(Claims, ImpossibleHitsAreRefusedWithTheirIndex) {
  const Traced traced(scenes::load_scene("tetra:n=2"));
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto refusal = [&](const std::function<void(HitTable&)>& spoil, const Form& form) {
    HitTable table = traced.hits;
    spoil(table);
    ClaimVerifier verifier(traced.scene);
    // The index counts over all parts, and a refused part does not count.
    verifier.add(std::span(traced.rays).first(2),
                 {.t = std::span(traced.hits.t).first(2),
                  .primitives = std::span(traced.hits.primitives).first(2)});
    try {
      verifier.add(traced.rays, form.claims(table));
    } catch (const InvalidClaim& error) {
      EXPECT_EQ(error.index, 9U);
      EXPECT_EQ(verifier.finish().rays, 2U);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const Form& by_t = forms()[0];
  const Form& by_point = forms()[3];
  const auto spoil_t = [](float t) { return [t](HitTable& h) { h.t[7] = t; }; };
  EXPECT_EQ(refusal(spoil_t(kNaN), by_t), "t is not a number; a miss has t = infinity");
  EXPECT_EQ(refusal(spoil_t(-accel::kInfinity), by_t), "t is -infinity; a miss has t = infinity");
  EXPECT_EQ(refusal([](HitTable& h) { h.primitives[7] = 16; }, by_t),
            "there is no primitive 16: the scene's are 0 to 15");
  EXPECT_EQ(refusal([](HitTable& h) { h.triangles[7] = 999; }, forms()[1]),
            "there is no triangle 999: the scene's are 0 to 15");
  EXPECT_EQ(refusal(
                [](HitTable& h) {
                  h.primitives[7] = 3;
                  h.t[7] = accel::kInfinity;
                },
                by_t),
            "primitive 3 is named, but its place is infinite");
  EXPECT_EQ(refusal([](HitTable& h) { h.points[7].y = kNaN; }, by_point),
            "a coordinate of the point is not a number; a miss has infinite ones");
  EXPECT_EQ(refusal(
                [](HitTable& h) {
                  h.points[7] = {1.0F, accel::kInfinity, 1.0F};
                },
                by_point),
            "some coordinates of the point are infinite");
  EXPECT_EQ(refusal([](HitTable& h) { h.occluded[7] = 2; }, forms()[6]), "2 is neither 0 nor 1");

  std::vector<accel::Ray> rays = traced.rays;
  rays[4].direction = glm::vec3(0.0F);
  ClaimVerifier verifier(traced.scene);
  EXPECT_THROW(verifier.add(rays, {.t = traced.hits.t}), InvalidClaim);
}

TEST(Claims, InconsistentArraysAreRefused) {
  const Traced traced(scenes::load_scene("tetra:n=2"));
  const HitTable& h = traced.hits;
  ClaimVerifier verifier(traced.scene);
  for (const ClaimedHits& wrong :
       {ClaimedHits{.t = h.t, .points = h.points}, ClaimedHits{.primitives = h.primitives},
        ClaimedHits{.t = h.t, .occluded = h.occluded},
        ClaimedHits{.t = h.t, .primitives = h.primitives, .triangles = h.triangles},
        ClaimedHits{.t = h.t, .primitives = std::span(h.primitives).first(3)},
        ClaimedHits{.t = std::span(h.t).first(3)}}) {
    EXPECT_THROW(verifier.add(traced.rays, wrong), std::logic_error);
  }
}

// The program reports a hit on an upright triangle, which the ray just misses. Behind this
// triangle, the ray meets a horizontal one at grazing incidence, whose plane nearly contains the
// claimed point.
TEST(Claims, APointInThePlaneButFarFromThePrimitiveIsNotOnIt) {
  scenes::SceneBuilder builder("level and upright");
  const glm::dvec3 level[] = {{5, 0, -2}, {9, 0, 0}, {5, 0, 2}};
  const glm::dvec3 upright[] = {{1, -1, 5e-7}, {1, 1, 5e-7}, {1, 0, 1}};
  builder.add_polygon(level);
  builder.add_polygon(upright);
  const scenes::Scene scene = std::move(builder).build();
  const accel::Ray ray{{0.0F, 7e-7F, 0.0F}, 0.0F, {1.0F, -1e-7F, 0.0F}};
  const float t = 1.0F;
  ClaimVerifier verifier(scene);
  verifier.add({&ray, 1}, {.t = {&t, 1}});
  const DiffReport report = verifier.finish();
  EXPECT_EQ(report.hits, 1U) << "the horizontal triangle";
  ASSERT_EQ(report.count(DiffClass::kGraze), 1U);
  EXPECT_EQ(report.examples.front().answer->primitive, 1U);
}

// A program that computes points in double may place them one rounding before t_min.
TEST(Claims, APointAtTheStartOfTheRayIsInTheInterval) {
  const Traced traced(scenes::load_scene("tetra:n=2"));
  const std::size_t i = clear_hit(traced);
  accel::Ray ray = traced.rays[i];
  ray.t_min = traced.hits.t[i];
  glm::vec3 point = traced.hits.points[i];
  point -= 4e-8F * ray.direction;
  ClaimVerifier verifier(traced.scene);
  verifier.add({&ray, 1}, {.points = {&point, 1}});
  EXPECT_EQ(verifier.finish().count(DiffClass::kStructureError), 0U);
}

}  // namespace
}  // namespace beambench::verify
