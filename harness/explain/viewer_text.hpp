#pragma once
// The parts of a page, embedded in the program.

#include <string_view>

namespace beambench::explain {

/// Each of these returns a file: those of `viewer/`, and three.js with its orbit controls. The
/// latter are empty if scripts/setup had not fetched them when the program was built.
std::string_view page_text();
std::string_view style_text();
std::string_view viewer_text();
std::string_view three_text();
std::string_view controls_text();

}  // namespace beambench::explain
