#include "harness/rays/share_warning.hpp"

#include <fmt/format.h>

namespace beambench::rays {

std::optional<std::string> share_warning(const Question& question, std::uint64_t hits) {
  constexpr double kLeast = 0.01;
  const double share = static_cast<double>(hits) / static_cast<double>(question.size());
  if (share >= kLeast && share <= 1.0 - kLeast) return std::nullopt;
  return fmt::format(
      "{} of the {} {} rays {} ({:.3g}%): {}", hits, question.size(), question.label(),
      question.query() == Query::kAnyHit ? "are occluded" : "hit something", 100.0 * share,
      share < kLeast ? "they compare how structures miss, and little else"
                     : "there is hardly a miss among them");
}

}  // namespace beambench::rays
