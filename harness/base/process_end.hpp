#pragma once
// Words for how another process ended.

#include <string>

namespace beambench::base {

/// Returns whether a status (waitpid) is that of a crash: ended by a signal that a fault of its own
/// raised, not by one that somebody sent.
bool is_crash(int status);

/// Returns how a process ended, by its status: "ended with exit code 3", "crashed (SIGSEGV:
/// Segmentation fault)", "was ended by SIGKILL (Killed)".
std::string describe_end(int status);

}  // namespace beambench::base
