#pragma once
// What a plug-in brings, looked over before the program takes it in.

#include "harness/plugin/plugin.hpp"

namespace beambench::plugin {

/// Throws PluginError with what is wrong: nothing is there, a name is taken, given twice or no
/// name, a text or a function is missing, a parameter's default is not in its range.
void check_contents(const PluginContents& contents);

}  // namespace beambench::plugin
