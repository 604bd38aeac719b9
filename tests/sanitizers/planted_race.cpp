// A race between two TBB tasks, which the thread sanitizer must find, and a sum whose tasks TBB
// orders, in which it must not find a race.

#include <cstddef>
#include <cstdio>
#include <numeric>
#include <vector>

#include <tbb/parallel_for.h>

namespace {

constexpr std::size_t kCount = 1U << 20U;

/// Each element is written by one task, and is read after all tasks have ended.
long sum_in_order() {
  std::vector<long> squares(kCount);
  tbb::parallel_for(std::size_t{0}, kCount,
                    [&](std::size_t i) { squares[i] = static_cast<long>(i % 7); });
  return std::accumulate(squares.begin(), squares.end(), 0L);
}

long sum_with_a_race() {
  long sum = 0;
  tbb::parallel_for(std::size_t{0}, kCount,
                    [&](std::size_t i) { sum += static_cast<long>(i % 7); });
  return sum;
}

}  // namespace

int main(int argc, char** /*argv*/) {
  std::printf("%ld\n", argc > 1 ? sum_with_a_race() : sum_in_order());
}
