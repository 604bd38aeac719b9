#pragma once
// Finds the name that a misspelled word probably means ("did you mean ...?").

#include <span>
#include <string>
#include <string_view>

namespace beambench {

/// Returns the element of `names` that the user most likely meant by `word`: first the equivalent
/// of a name used by other programs (`octree` for samet, `--size` for --resolution), then the only
/// name that contains the word as a part (`bvh` for sah-bvh), then the first name with the smallest
/// edit distance (Levenshtein 1966). Upper and lower case count as equal. Returns an empty string
/// if no name is close, that is, if more than half of the word would have to be changed.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// Returns "did you mean 'sah-bvh'? ", for the middle of a message, or an empty string if no name
/// is close.
std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace beambench
