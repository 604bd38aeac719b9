#pragma once
// Describes how another process ended.

#include <string>

namespace beambench::base {

/// Returns whether a status (waitpid) is that of a crash: the process was ended by a signal that
/// its own fault raised, not by one that was sent to it.
bool is_crash(int status);

/// Returns how a process ended, by its status: "ended with exit code 3", "crashed (SIGSEGV:
/// Segmentation fault)", "was ended by SIGKILL (Killed)".
std::string describe_end(int status);

}  // namespace beambench::base
