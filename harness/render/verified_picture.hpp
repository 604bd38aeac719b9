#pragma once
// The verification of a whole picture: it is right when every answer is that it depends on.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::render {

/// Counts the work of the structure behind it.
class CountedQueries : public accel::TraversalAccelerator<CountedQueries> {
 public:
  CountedQueries(const accel::Accelerator& structure, accel::WorkCounters& counters)
      : structure_(structure), counters_(counters) {}

  accel::Statistics statistics() const override { return structure_.statistics(); }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    return structure_.closest_hit(ray, &counters_);
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    return structure_.any_hit(ray, &counters_);
  }

 private:
  const accel::Accelerator& structure_;
  accel::WorkCounters& counters_;
};

/// Rays and their results, each kind of query in its order.
struct AskedRays {
  std::vector<accel::Ray> closest;
  std::vector<std::optional<accel::Hit>> hits;  ///< of `closest`
  std::vector<accel::Ray> any;
  std::vector<std::uint8_t> any_hits;  ///< of `any`
};

/// Records the queries and results of the structure behind it.
class RecordedQueries : public accel::TraversalAccelerator<RecordedQueries> {
 public:
  RecordedQueries(const accel::Accelerator& structure, AskedRays& asked)
      : structure_(structure), asked_(asked) {}

  accel::Statistics statistics() const override { return structure_.statistics(); }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    asked_.closest.push_back(ray);
    return asked_.hits.emplace_back(structure_.closest_hit(ray, nullptr));
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    asked_.any.push_back(ray);
    return asked_.any_hits.emplace_back(structure_.any_hit(ray, nullptr) ? 1 : 0) != 0;
  }

 private:
  const accel::Accelerator& structure_;
  AskedRays& asked_;
};

/// Returns recorded results to the same queries in the same order: what is left of a time is all
/// that is not the structure's.
class ReplayedAnswers : public accel::TraversalAccelerator<ReplayedAnswers> {
 public:
  explicit ReplayedAnswers(const AskedRays& asked) : asked_(asked) {}

  accel::Statistics statistics() const override { return {}; }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray&, Counting&) const {
    return asked_.hits[next_closest_++];
  }
  template <class Counting>
  bool find_any(const accel::Ray&, Counting&) const {
    return asked_.any_hits[next_any_++] != 0;
  }

 private:
  const AskedRays& asked_;
  mutable std::size_t next_closest_ = 0;
  mutable std::size_t next_any_ = 0;
};

/// The oracle as a structure: its hits rounded to float.
class OracleQueries : public accel::TraversalAccelerator<OracleQueries> {
 public:
  explicit OracleQueries(const accel::embree::EmbreeOracle& oracle) : oracle_(oracle) {}

  accel::Statistics statistics() const override { return {}; }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    const std::optional<accel::embree::ExactHit> hit = oracle_.closest_hit(ray);
    if (!hit) return std::nullopt;
    return accel::Hit{static_cast<float>(hit->t), hit->primitive};
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    return oracle_.any_hit(ray);
  }

 private:
  const accel::embree::EmbreeOracle& oracle_;
};

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

/// All of them together: counts added up, the worst verdict, no examples.
verify::DiffReport sum_of(const std::vector<VerifiedRays>& verified);

}  // namespace beambench::render
