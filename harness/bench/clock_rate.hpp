#pragma once
// How fast the processor's clock runs just now.

namespace beambench::bench {

/// The rate of the core's clock in GHz: from the time of a chain of dependent integer
/// multiplications, three cycles each on the x86 processors of the last fifteen years (Fog,
/// Instruction tables); elsewhere it is right but for a constant factor. The fastest of a few
/// slices, some 30 us in all: an interrupt makes a slice longer, nothing makes one shorter.
double clock_ghz();

}  // namespace beambench::bench
