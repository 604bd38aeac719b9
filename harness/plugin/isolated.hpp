#pragma once
// Runs code of plug-ins in child processes, so that a crash or an endless loop ends only the child
// process.

#include <functional>
#include <string>

namespace beambench::plugin {

/// Returns whether a shared object is loaded, so that a crash of its structures would end this
/// process. Returns false with BEAMBENCH_UNGUARDED, for debuggers.
bool must_isolate();

/// Calls `work` in a child process, or in this process unless `must_isolate()`, and returns its
/// result. Rethrows InputError and accel::UnsupportedError; any other exception, a crash, and the
/// end of the process become a PluginError, which names the plug-in and its action. So does an
/// action (building a structure over a scene and querying it) that takes longer than `seconds`,
/// after which the process is ended.
///
/// The child has only the thread that calls this function, so this process should not have used
/// several threads before.
std::string run_isolated(const std::function<std::string()>& work, double seconds);

}  // namespace beambench::plugin
