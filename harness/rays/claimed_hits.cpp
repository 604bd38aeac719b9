#include "harness/rays/claimed_hits.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace beambench::rays {

std::size_t ClaimedHits::size() const {
  const bool any = !occluded.empty();
  const bool closest = !t.empty() || !points.empty();
  if (any == closest || (!t.empty() && !points.empty()) ||
      (!primitives.empty() && !triangles.empty()) ||
      (any && (!primitives.empty() || !triangles.empty()))) {
    const std::array sizes{t.size(), points.size(), primitives.size(), triangles.size(),
                           occluded.size()};
    if (std::ranges::all_of(sizes, [](std::size_t size) { return size == 0; })) return 0;
    throw std::logic_error(
        "hits must be either t or points, with primitives, triangles or neither, or occluded "
        "alone");
  }
  const std::size_t count = std::max({t.size(), points.size(), occluded.size()});
  for (const std::size_t size : {primitives.size(), triangles.size()}) {
    if (size != 0 && size != count) {
      throw std::logic_error("hits and the ids of what they hit differ in number");
    }
  }
  return count;
}

ClaimedHits ClaimedHits::part(std::size_t first, std::size_t count) const {
  const auto cut = [&](auto span) { return span.empty() ? span : span.subspan(first, count); };
  return {cut(t), cut(points), cut(primitives), cut(triangles), cut(occluded)};
}

}  // namespace beambench::rays
