#include "accel/core/share_rows.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace beambench::accel {

void share_rows(int rows, const std::function<void(int begin, int end)>& work) {
  tbb::parallel_for(tbb::blocked_range(0, rows),
                    [&](const auto& range) { work(range.begin(), range.end()); });
}

}  // namespace beambench::accel
