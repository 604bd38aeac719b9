#pragma once
// The verification of a whole picture: it is right when every answer is that it depends on.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/verification.hpp"

namespace beambench::render {

/// A structure whose queries are answered by two functions of a ray.
template <class Closest, class Any>
class AnsweredBy : public accel::TraversalAccelerator<AnsweredBy<Closest, Any>> {
 public:
  AnsweredBy(Closest closest, Any any) : closest_(std::move(closest)), any_(std::move(any)) {}

  accel::Statistics statistics() const override { return {}; }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    return closest_(ray);
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    return any_(ray);
  }

 private:
  mutable Closest closest_;
  mutable Any any_;
};

/// Rays and their results, each kind of query in its order.
struct AskedRays {
  std::vector<accel::Ray> closest;
  std::vector<std::optional<accel::Hit>> hits;  ///< of `closest`
  std::vector<accel::Ray> any;
  std::vector<std::uint8_t> any_hits;  ///< of `any`
};

/// Counts the work of a structure.
inline auto counted_queries(const accel::Accelerator& structure, accel::WorkCounters& counters) {
  return AnsweredBy([&](const accel::Ray& ray) { return structure.closest_hit(ray, &counters); },
                    [&](const accel::Ray& ray) { return structure.any_hit(ray, &counters); });
}

/// Returns recorded results to the same queries in the same order: what is left of a time is all
/// that is not the structure's.
inline auto replayed_results(const AskedRays& asked) {
  return AnsweredBy(
      [next = asked.hits.data()](const accel::Ray&) mutable { return *next++; },
      [next = asked.any_hits.data()](const accel::Ray&) mutable { return *next++ != 0; });
}

/// The oracle: its hits rounded to float.
inline auto oracle_queries(const accel::embree::EmbreeOracle& oracle) {
  return AnsweredBy([&](const accel::Ray& ray) { return verify::rounded(oracle.closest_hit(ray)); },
                    [&](const accel::Ray& ray) { return oracle.any_hit(ray); });
}

/// The kinds of rays that follow camera rays.
inline constexpr std::size_t kFollowingRays = 3;
template <class Value>
using ByFollowingRays = std::array<Value, kFollowingRays>;
inline constexpr ByFollowingRays<std::string_view> kFollowingRayNames{"reflected", "refracted",
                                                                      "shadow"};

/// A picture with all that a structure was asked for it.
struct RecordedPicture {
  accel::HitBuffer primary;  ///< the hits of camera rays
  ByFollowingRays<AskedRays> asked;
  Image image;
  RayCensus census;
};

/// Draws the picture that the hits `primary` of `rays` begin, on this thread alone; some 50 bytes a
/// ray. Throws InvalidHit.
RecordedPicture record_picture(const scenes::Scene& scene, const accel::Accelerator& structure,
                               const accel::PrimaryRays& rays, accel::HitBuffer primary,
                               const WhittedOptions& options, rays::HitCheck check);

/// The rays of one kind, and how they were answered.
struct VerifiedRays {
  std::string_view kind;  ///< "camera", or one of kFollowingRayNames
  rays::TraceInput input;
  verify::DiffReport report;
};

/// Verifies every ray of a picture, each kind (and query) as a list of its own; first the camera
/// rays, whose true hits are `primary`. Kinds without rays are left out.
std::vector<VerifiedRays> verify_recorded_picture(const verify::ReferenceHits& primary,
                                                  RecordedPicture picture,
                                                  accel::Conformance conformance);

/// The disputed rays of the kinds whose verdict is bad, described.
std::vector<std::string> described_examples(const scenes::Scene& scene,
                                            const std::vector<VerifiedRays>& verified);

/// All of them together: counts added up, the worst verdict, no examples.
verify::DiffReport sum_of(const std::vector<VerifiedRays>& verified);

/// As `verify_scene`, for `whitted` rays. Bit-exact structures must draw the same picture;
/// `different_bits` counts pixels.
std::vector<verify::VerifiedCell> verify_picture(const scenes::Scene& scene,
                                                 const rays::ImageOfRays& image,
                                                 const rays::RayChoice& choice,
                                                 std::vector<accel::StructureChoice> contenders,
                                                 base::Progress& progress);

}  // namespace beambench::render
