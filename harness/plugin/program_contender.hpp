#pragma once
// A structure in a program of its own, which traces batches in shared memory (README.md, "A program
// as a contender").

#include <string>

#include "accel/core/registry.hpp"

namespace beambench::plugin {

/// The figures of `Statistics` that state times by the program's own clock.
inline constexpr const char* kSelfReportedBuild = "self_reported_build_ms";
inline constexpr const char* kSelfReportedTrace = "self_reported_trace_ms";
/// The end of a `library_version` with such times.
inline constexpr const char* kSelfReportedNote = " (times are self-reported)";

/// Starts the program, and returns the structure that it describes. Throws PluginError if it does
/// not describe one.
accel::StructureInfo structure_of_program(const std::string& file);

}  // namespace beambench::plugin
