#pragma once
// The rows of an image, shared among threads.

#include <functional>

namespace beambench::accel {

/// Calls `work(begin, end)` for parts of [0, rows) that together are all of it, on the threads of
/// the TBB arena that calls this. Which parts there are, and in which order, is not determined.
void share_rows(int rows, const std::function<void(int begin, int end)>& work);

}  // namespace beambench::accel
