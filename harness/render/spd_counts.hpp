#pragma once
// The rays of whole pictures as Haines published them with his databases (SPD).

#include <cstdint>
#include <span>
#include <string_view>

namespace beambench::render {

/// Rays by kind of one scene at its standard size: 513 x 513 eye rays through the corners of
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
/// He expects other ray tracers within about 10%; ours is up to 0.5% above, for his eye rays seem
/// to be spread over one pixel more. Of `shells`, `jacks`, `lattice` and `sombrero` no counts are
/// published.
std::span<const PublishedCounts> published_spd_counts();

/// Of the scene of that name; nullptr where none are published.
const PublishedCounts* find_published_counts(std::string_view scene);

}  // namespace beambench::render
