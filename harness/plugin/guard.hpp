#pragma once
// Foreign code runs in a process of its own, so that its crash ends that process only.

#include <memory>

#include "harness/plugin/activity.hpp"

namespace beambench::plugin {

/// Runs this program once more with the same arguments, in a process of its own that finds by
/// `guarded_activity` that it is guarded, and returns what this one should end with: what that one
/// ended with, or where foreign code crashed, hung while it was loaded or ended the process, 1
/// after a sentence on stderr that says which and where (2 when it was being loaded). Where that
/// happened to a cell of a sweep, the program is run again, with the cell among the broken ones.
/// Signals to end are passed on. For the start of a program.
int run_guarded(char** arguments);

/// Where a guarded process records what it is doing; nullptr in others.
std::unique_ptr<Activity> guarded_activity();

}  // namespace beambench::plugin
