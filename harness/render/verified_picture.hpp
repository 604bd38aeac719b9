#pragma once
// The verification of a whole picture: it is right when every answer is that it depends on.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
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

/// Rays and their results, each kind of query in its order.
struct AskedRays {
  std::vector<accel::Ray> closest;
  std::vector<std::optional<accel::Hit>> hits;  ///< of `closest`
  std::vector<accel::Ray> any;
  std::vector<std::uint8_t> any_hits;  ///< of `any`
};

/// What stands between a picture and its structure: the queries that pictures make, single and of
/// batches.
class FollowingQueries : public accel::Accelerator {
 public:
  /// A picture is given the hits of its camera rays; never called.
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters* counters) const override;
  accel::Statistics statistics() const override { return {}; }
};

/// Counts the work of a structure.
class CountedQueries : public FollowingQueries {
 public:
  /// Both must outlive this.
  CountedQueries(const accel::Accelerator& structure, accel::WorkCounters& counters)
      : structure_(&structure), counters_(&counters) {}

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray, accel::WorkCounters*) const override;
  bool any_hit(const accel::Ray& ray, accel::WorkCounters*) const override;
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters*) const override;
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters*) const override;

 private:
  const accel::Accelerator* structure_;
  accel::WorkCounters* counters_;
};

/// Keeps all rays and results. Not for use from several threads.
class RecordedQueries : public FollowingQueries {
 public:
  /// Both must outlive this.
  RecordedQueries(const accel::Accelerator& structure, AskedRays& asked)
      : structure_(&structure), asked_(&asked) {}

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray, accel::WorkCounters*) const override;
  bool any_hit(const accel::Ray& ray, accel::WorkCounters*) const override;
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters*) const override;
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters*) const override;

 private:
  const accel::Accelerator* structure_;
  AskedRays* asked_;
};

/// Returns recorded results to the same queries in the same order: what is left of a time is all
/// that is not the structure's. Not for use from several threads.
class ReplayedResults : public FollowingQueries {
 public:
  /// `asked` must outlive this.
  explicit ReplayedResults(const AskedRays& asked)
      : hit_(asked.hits.data()), any_hit_(asked.any_hits.data()) {}

  std::optional<accel::Hit> closest_hit(const accel::Ray&, accel::WorkCounters*) const override;
  bool any_hit(const accel::Ray&, accel::WorkCounters*) const override;
  void closest_hits(const accel::RayBatch&, accel::HitBuffer& buffer,
                    accel::WorkCounters*) const override;
  void any_hits(const accel::RayBatch&, std::span<std::uint8_t> hits,
                accel::WorkCounters*) const override;

 private:
  mutable const std::optional<accel::Hit>* hit_;
  mutable const std::uint8_t* any_hit_;
};

/// The oracle: its hits rounded to float.
class OracleQueries : public accel::TraversalAccelerator<OracleQueries> {
 public:
  /// The oracle must outlive this.
  explicit OracleQueries(const accel::embree::EmbreeOracle& oracle) : oracle_(&oracle) {}

  accel::Statistics statistics() const override { return {}; }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    return verify::rounded(oracle_->closest_hit(ray));
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    return oracle_->any_hit(ray);
  }

 private:
  const accel::embree::EmbreeOracle* oracle_;
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
RecordedPicture record_picture(const std::shared_ptr<const ShadedScene>& scene,
                               const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                               accel::HitBuffer primary, const WhittedOptions& options,
                               rays::HitCheck check);

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
