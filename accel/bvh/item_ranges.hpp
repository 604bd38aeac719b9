#pragma once
// Divides items into ranges for threads.

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_group.h>

#include "accel/bvh/object_split.hpp"

namespace beambench::accel::bvh {

/// Returns a context whose tasks compute in the calling thread's floating-point mode. The default
/// is the mode of the first thread that used TBB, in which tiny areas may be 0.
inline tbb::task_group_context calling_mode() {
  return tbb::task_group_context(
      tbb::task_group_context::bound,
      tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
}

/// Ranges that together are [0, items): one range, or several for a parallel build.
class ItemRanges {
 public:
  ItemRanges(std::size_t items, bool parallel)
      : items_(items),
        count_(parallel ? std::clamp<std::size_t>(items / kParallelItems, 1, 64) : 1) {}

  std::size_t count() const { return count_; }

  /// Calls `work(range, begin, end)` for all ranges, at the same time if there are several.
  template <class Work>
  void for_each(const Work& work) const {
    if (count_ == 1) return work(std::size_t{0}, std::size_t{0}, items_);
    tbb::task_group_context mode = calling_mode();
    tbb::parallel_for(
        std::size_t{0}, count_,
        [&](std::size_t range) {
          work(range, items_ * range / count_, items_ * (range + 1) / count_);
        },
        mode);
  }

 private:
  std::size_t items_;
  std::size_t count_;
};

}  // namespace beambench::accel::bvh
