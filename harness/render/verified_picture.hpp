#pragma once
// Verifies a whole picture: it is correct if every result that it depends on is correct.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/oracle/oracle.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/verification.hpp"

namespace beambench::render {

/// Rays and their results, in order for each kind of query.
struct AskedRays {
  std::vector<accel::Ray> closest;
  std::vector<std::optional<accel::Hit>> hits;  ///< of the rays in `closest`
  std::vector<accel::Ray> any;
  std::vector<std::uint8_t> any_hits;  ///< of the rays in `any`
};

/// Forwards queries to a structure and records all rays and results. Not thread-safe.
class RecordedQueries : public accel::ForwardingAccelerator {
 public:
  /// Both arguments must outlive this object.
  RecordedQueries(const accel::Accelerator& structure, AskedRays& asked)
      : ForwardingAccelerator(structure), asked_(&asked) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override;
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override;

 private:
  AskedRays* asked_;
};

/// A structure that returns recorded results for the same queries in the same order, so that
/// measured times exclude tracing. Not thread-safe.
class ReplayedResults : public accel::Accelerator {
 public:
  /// `asked` must outlive this object.
  explicit ReplayedResults(const AskedRays& asked)
      : hit_(asked.hits.data()), any_hit_(asked.any_hits.data()) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override;
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override;
  accel::Statistics statistics() const override { return {}; }

 private:
  mutable const std::optional<accel::Hit>* hit_;
  mutable const std::uint8_t* any_hit_;
};

/// The oracle, with its hits rounded to float.
class OracleQueries : public accel::TraversalAccelerator<OracleQueries> {
 public:
  /// The oracle must outlive this object.
  explicit OracleQueries(const accel::oracle::Oracle& oracle) : oracle_(&oracle) {}

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
  const accel::oracle::Oracle* oracle_;
};

/// The kinds of rays that follow camera rays.
inline constexpr std::size_t kFollowingRays = 3;
template <class Value>
using ByFollowingRays = std::array<Value, kFollowingRays>;
inline constexpr ByFollowingRays<std::string_view> kFollowingRayNames{"reflected", "refracted",
                                                                      "shadow"};

/// A picture, with all queries made for it.
struct RecordedPicture {
  accel::HitBuffer primary;  ///< the hits of camera rays
  ByFollowingRays<AskedRays> asked;
  Image image;
  RayCensus census;
};

/// Draws the picture that follows from `primary`, the hits of `rays`, on this thread only; takes
/// about 50 bytes per ray. Throws InvalidHit.
RecordedPicture record_picture(const std::shared_ptr<const ShadedScene>& scene,
                               const accel::Accelerator& structure, const accel::PrimaryRays& rays,
                               accel::HitBuffer primary, const WhittedOptions& options,
                               rays::HitCheck check);

/// Throws UnsupportedError if a structure does not support everything that a picture needs: an
/// image, lists of rays and single rays.
void require_support(const accel::StructureChoice& choice);

/// The rays of one kind, and the verification of their results.
struct VerifiedRays {
  std::string_view kind;  ///< "camera", or one of kFollowingRayNames
  rays::TraceInput input;
  verify::DiffReport report;
};

/// Verifies every ray of a picture, as a separate list for each kind and query. The first list has
/// the camera rays, whose correct hits are `primary`. Omits kinds without rays.
std::vector<VerifiedRays> verify_recorded_picture(const verify::ReferenceHits& primary,
                                                  RecordedPicture picture,
                                                  accel::Conformance conformance);

/// Describes the disputed rays of the kinds with a bad verdict.
std::vector<std::string> described_examples(const scenes::Scene& scene,
                                            const std::vector<VerifiedRays>& verified);

/// Combines all reports: sums the counts and keeps the worst verdict, without examples.
verify::DiffReport sum_of(const std::vector<VerifiedRays>& verified);

/// Verifies `whitted` rays, as `verify_scene` does for other kinds. Bit-exact structures must draw
/// the same picture; `different_bits` counts pixels.
std::vector<verify::VerifiedCell> verify_picture(const scenes::Scene& scene,
                                                 const rays::ImageOfRays& image,
                                                 const rays::RayChoice& choice,
                                                 std::vector<accel::StructureChoice> contenders,
                                                 base::Progress& progress);

}  // namespace beambench::render
