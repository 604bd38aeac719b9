#pragma once
// How many rays of which kind a picture took.

#include <cstdint>
#include <span>
#include <string_view>

namespace beambench::render {

/// Rays by kind, as the literature counts them (Haines, "A proposal for standard graphics
/// environments", IEEE CG&A 7(11), 1987).
struct RayCensus {
  std::uint64_t eye = 0;
  std::uint64_t eye_hits = 0;
  std::uint64_t reflected = 0;
  std::uint64_t refracted = 0;
  std::uint64_t totally_reflected = 0;  ///< of the reflected: in place of a refracted ray
  std::uint64_t secondary_hits = 0;     ///< of reflected and refracted rays
  std::uint64_t too_faint = 0;          ///< not traced: too small a part of the pixel's color
  std::uint64_t shadow = 0;             ///< a point and a light that its side of the surface faces
  std::uint64_t shadow_hidden = 0;      ///< of these: the light is hidden by something opaque
  std::uint64_t shadow_cached = 0;      ///< of these: the shadow cache knew it
  std::uint64_t shadow_listed = 0;      ///< of all shadow rays: the light buffer answered
  std::uint64_t shadow_tests = 0;       ///< ray-primitive tests of cache and light buffer
  std::uint64_t shadow_queries = 0;     ///< closest-hit and any-hit queries for shadow rays

  /// Rays of all kinds.
  std::uint64_t all_rays() const { return eye + reflected + refracted + shadow; }

  RayCensus& operator+=(const RayCensus& other) {
    eye += other.eye;
    eye_hits += other.eye_hits;
    reflected += other.reflected;
    refracted += other.refracted;
    totally_reflected += other.totally_reflected;
    secondary_hits += other.secondary_hits;
    too_faint += other.too_faint;
    shadow += other.shadow;
    shadow_hidden += other.shadow_hidden;
    shadow_cached += other.shadow_cached;
    shadow_listed += other.shadow_listed;
    shadow_tests += other.shadow_tests;
    shadow_queries += other.shadow_queries;
    return *this;
  }
  friend bool operator==(const RayCensus&, const RayCensus&) = default;
};

/// Rays by kind of one scene at its standard size: 513 x 513 camera rays through the corners of
/// pixels, depth 5, none left out for being faint.
struct PublishedCounts {
  std::string_view scene;  ///< the scene's name with its parameters: `balls:n=4`
  std::uint64_t eye_hits;
  std::uint64_t reflected;
  std::uint64_t refracted;  ///< rays that are reflected totally in place of it included
  std::uint64_t shadow;
};

/// The seven scenes of "Database Analysis" in the README of SPD 3.14 (Haines, "A proposal for
/// standard graphics environments", IEEE CG&A 7(11), 1987; realtimerendering.com/resources/SPD).
/// He expects other ray tracers within about 10%; ours is up to 0.5% above, for his camera rays
/// seem to be spread over one pixel more. Of `shells`, `jacks`, `lattice` and `sombrero` no counts
/// are published.
std::span<const PublishedCounts> published_spd_counts();

/// Of the scene of that name; nullptr where none are published.
const PublishedCounts* find_published_counts(std::string_view scene);

}  // namespace beambench::render
