#pragma once
// "Did you mean ...?"

#include <span>
#include <string>
#include <string_view>

namespace beambench {

/// The one of `names` that was most likely meant by `word`: what other programs call by that word
/// (`octree` for samet, `--size` for --resolution), else the only name of which it is a part
/// (`bvh` for sah-bvh), else the one with the smallest edit distance (Levenshtein 1966), the first
/// of several. Empty when none is near: more than half of the word would have to be changed.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// "did you mean 'sah-bvh'? ", for the middle of a message; empty when no name is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace beambench
