#pragma once
// The time of a processor that is not there.

#include <functional>

namespace beambench::cluster {

/// Lets seconds of the (simulated) processor pass.
using Spend = std::function<void(double seconds)>;

}  // namespace beambench::cluster
