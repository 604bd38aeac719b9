#pragma once
// Counts the rays of a picture by kind.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace beambench::render {

/// Rays by kind, as the literature counts them (Haines, "A proposal for standard graphics
/// environments", IEEE CG&A 7(11), 1987).
struct RayCensus {
  std::uint64_t eye = 0;
  std::uint64_t eye_hits = 0;
  std::uint64_t reflected = 0;
  std::uint64_t refracted = 0;
  std::uint64_t totally_reflected = 0;  ///< reflected rays that replace a refracted ray
  std::uint64_t secondary_hits = 0;     ///< hits of reflected and refracted rays
  std::uint64_t too_faint = 0;          ///< not traced: too small a share of the pixel's color
  std::uint64_t shadow = 0;             ///< pairs of a point and a light that it faces
  std::uint64_t shadow_hidden = 0;      ///< shadow rays whose light an opaque surface hides
  std::uint64_t shadow_cached = 0;      ///< hidden shadow rays found by the shadow cache
  std::uint64_t shadow_listed = 0;      ///< shadow rays decided by the light buffer
  std::uint64_t shadow_tests = 0;       ///< ray-primitive tests of cache and light buffer
  std::uint64_t shadow_queries = 0;     ///< closest-hit and any-hit queries for shadow rays

  /// Returns the number of rays of all kinds.
  std::uint64_t all_rays() const { return eye + reflected + refracted + shadow; }

  RayCensus& operator+=(const RayCensus& other);
  friend bool operator==(const RayCensus&, const RayCensus&) = default;
};

/// All counts in order, and their names in records.
struct CensusCount {
  const char* name;
  std::uint64_t RayCensus::*count;
};
inline constexpr std::array kCensusCounts{
    CensusCount{"eye_rays", &RayCensus::eye},
    CensusCount{"eye_hits", &RayCensus::eye_hits},
    CensusCount{"reflected_rays", &RayCensus::reflected},
    CensusCount{"refracted_rays", &RayCensus::refracted},
    CensusCount{"totally_reflected", &RayCensus::totally_reflected},
    CensusCount{"secondary_hits", &RayCensus::secondary_hits},
    CensusCount{"too_faint", &RayCensus::too_faint},
    CensusCount{"shadow_rays", &RayCensus::shadow},
    CensusCount{"shadow_hidden", &RayCensus::shadow_hidden},
    CensusCount{"shadow_cached", &RayCensus::shadow_cached},
    CensusCount{"shadow_listed", &RayCensus::shadow_listed},
    CensusCount{"shadow_tests", &RayCensus::shadow_tests},
    CensusCount{"shadow_queries", &RayCensus::shadow_queries}};
static_assert(sizeof(RayCensus) == kCensusCounts.size() * sizeof(std::uint64_t));

inline RayCensus& RayCensus::operator+=(const RayCensus& other) {
  for (const CensusCount& each : kCensusCounts) this->*each.count += other.*each.count;
  return *this;
}

/// The counts of one scene at its standard size: 513 x 513 camera rays through the corners of
/// pixels, depth 5, with even the faintest rays traced.
struct PublishedCounts {
  std::string_view scene;  ///< the scene's name with its parameters: `balls:n=4`
  std::uint64_t eye_hits;
  std::uint64_t reflected;
  std::uint64_t refracted;  ///< including totally reflected rays
  std::uint64_t shadow;
};

/// The seven scenes of "Database Analysis" in the README of SPD 3.14 (Haines, "A proposal for
/// standard graphics environments", IEEE CG&A 7(11), 1987; realtimerendering.com/resources/SPD). He
/// expects other ray tracers to agree within about 10%; ours is up to 0.5% above, because his
/// camera rays seem to be spread over one more pixel. No counts are published for `shells`,
/// `jacks`, `lattice` and `sombrero`.
inline constexpr std::array<PublishedCounts, 7> kPublishedSpdCounts{{
    {"balls:n=4", 263'169, 175'095, 0, 954'368},
    {"gears:n=4", 245'086, 304'643, 207'564, 2'246'955},
    {"mount:n=6", 173'125, 354'769, 354'769, 412'922},
    {"rings:n=7", 263'169, 315'236, 0, 1'085'002},
    {"teapot:n=12", 161'120, 225'248, 0, 407'656},
    {"tetra:n=6", 49'788, 0, 0, 46'112},
    {"tree:n=11", 169'836, 0, 0, 1'097'419},
}};

/// Returns the published counts for the scene of that name; nullptr if there are none.
inline const PublishedCounts* find_published_counts(std::string_view scene) {
  const auto* const found = std::ranges::find(kPublishedSpdCounts, scene, &PublishedCounts::scene);
  return found == kPublishedSpdCounts.end() ? nullptr : found;
}

}  // namespace beambench::render
