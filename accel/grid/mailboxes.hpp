#pragma once
// Records which primitives a ray has been tested against.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenes/primitive.hpp"

namespace beambench::accel::grid {

/// One ray's view of the mailboxes (Arnaldi, Priol and Bouatouch, "A new space subdivision method
/// for ray tracing CSG modelled scenes", 1987; Amanatides and Woo, 1987): each primitive's mailbox
/// holds the last ray it was tested against.
///
/// The boxes belong to the thread, because queries are const and may run in several threads at
/// once. The number of each ray of a thread is unique across structures, so entries of other
/// structures are harmless.
class Mailboxes {
 public:
  explicit Mailboxes(std::size_t primitives) : scratch_(of_this_thread()) {
    if (scratch_.last_ray.size() < primitives) scratch_.last_ray.resize(primitives, 0);
    if (++scratch_.ray == 0) {  // all numbers are used up: start again
      std::fill(scratch_.last_ray.begin(), scratch_.last_ray.end(), 0);
      scratch_.ray = 1;
    }
  }

  /// Returns whether this is the first call for the primitive with this ray.
  bool is_first(scenes::PrimitiveId id) {
    std::uint32_t& last = scratch_.last_ray[id];
    if (last == scratch_.ray) return false;
    last = scratch_.ray;
    return true;
  }

 private:
  struct Scratch {
    std::vector<std::uint32_t> last_ray;  ///< one for each primitive
    std::uint32_t ray = 0;
  };
  static Scratch& of_this_thread() {
    thread_local Scratch scratch;
    return scratch;
  }

  Scratch& scratch_;
};

}  // namespace beambench::accel::grid
