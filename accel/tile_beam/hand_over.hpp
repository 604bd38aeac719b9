#pragma once
// Records which rays of a beam are handed over to the traversal of single rays.

#include <cstddef>
#include <vector>

#include "accel/core/work_counters.hpp"

namespace beambench::accel::tile_beam {

/// The policy of `beam_places`: records the rays handed over, by their places in the tile's image
/// or in the pencil's unit.
struct HandOverRecorder : NoCounting {
  explicit HandOverRecorder(std::size_t places) : is_handed_over(places) {}

  std::vector<bool> is_handed_over;
};

/// Counts a ray that a walk hands over, or records it if the policy is HandOverRecorder.
template <class Counting>
void note_handed_over(Counting& counting, std::size_t) {
  counting.add("handed_over_rays");
}
inline void note_handed_over(HandOverRecorder& recorder, std::size_t place) {
  recorder.is_handed_over[place] = true;
}

}  // namespace beambench::accel::tile_beam
