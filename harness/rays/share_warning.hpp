#pragma once
// A warning of rays that say little.

#include <cstdint>
#include <optional>
#include <string>

#include "harness/rays/question.hpp"

namespace beambench::rays {

/// A sentence where less than 1% or more than 99% of the rays hit anything (are occluded): times
/// over them compare how structures miss, or how they find anything at all, and little else.
std::optional<std::string> share_warning(const Question& question, std::uint64_t hits);

}  // namespace beambench::rays
