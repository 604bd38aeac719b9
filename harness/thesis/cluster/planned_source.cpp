#include "harness/thesis/cluster/planned_source.hpp"

#include <algorithm>
#include <utility>

#include "harness/base/stopwatch.hpp"
#include "harness/thesis/cluster/tasks.hpp"

namespace beambench::cluster {
namespace {

constexpr int kPixelsForEach = 16;

/// Returns the middle pixel of each group of 16 on a line.
std::vector<int> chosen(int begin, int length) {
  const int count = std::max(1, length / kPixelsForEach);
  std::vector<int> pixels;
  for (int i = 0; i < count; ++i) pixels.push_back(begin + (2 * i + 1) * length / (2 * count));
  return pixels;
}

double estimate_cost(const accel::beam::PixelRect& block, TaskWorker& worker) {
  const std::vector<int> columns = chosen(block.left, block.width);
  const std::vector<int> rows = chosen(block.top, block.height);
  Bytes result;
  const base::CpuStopwatch timer;
  for (const int y : rows) {
    for (const int x : columns) {
      Bytes task;
      write_task(BlockTask{{x, y, 1, 1}}, task);
      worker.perform(task, result, [] {});
    }
  }
  const double each = timer.seconds() / static_cast<double>(rows.size() * columns.size());
  return each * block.width * block.height;
}

}  // namespace

PlannedSource::PlannedSource(std::vector<Bytes> tasks, std::vector<Share> shares,
                             std::vector<double> estimates)
    : tasks_(std::move(tasks)), shares_(std::move(shares)), estimates_(std::move(estimates)) {}

bool PlannedSource::next(Bytes& task) {
  if (share_ == shares_.size()) return false;
  const Share& share = shares_[share_];
  last_ = share[place_];
  ByteWriter(task).put_bytes(tasks_[last_]);
  if (++place_ == share.size()) {
    ++share_;
    place_ = 0;
  }
  return true;
}

std::size_t PlannedSource::parcel_size() const {
  return share_ < shares_.size() ? shares_[share_].size() - place_ : 1;
}

double PlannedSource::estimate() const { return estimates_.empty() ? 0.0 : estimates_[last_]; }

std::vector<double> estimate_costs(std::span<const accel::beam::PixelRect> blocks,
                                   TaskWorker& worker) {
  std::vector<double> costs;
  costs.reserve(blocks.size());
  for (const accel::beam::PixelRect& block : blocks) costs.push_back(estimate_cost(block, worker));
  return costs;
}

}  // namespace beambench::cluster
