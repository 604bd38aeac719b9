#include "harness/thesis/cluster/image_division.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <utility>

namespace beambench::cluster {
namespace {

constexpr std::array<std::pair<std::string_view, Work>, 7> kNames{{
    {"beams", Work::kBeams},
    {"blocks", Work::kBlocks},
    {"tiles", Work::kTiles},
    {"contiguous", Work::kContiguous},
    {"interlaced", Work::kInterlaced},
    {"windows", Work::kWindows},
    {"pre-pass", Work::kPrePass},
}};

std::vector<Share> contiguous(std::size_t tasks, std::size_t shares) {
  std::vector<Share> divided(shares);
  for (std::size_t i = 0; i < tasks; ++i) divided[i * shares / tasks].push_back(i);
  return divided;
}

std::vector<Share> interlaced(std::size_t tasks, std::size_t shares) {
  std::vector<Share> divided(shares);
  for (std::size_t i = 0; i < tasks; ++i) divided[i % shares].push_back(i);
  return divided;
}

std::vector<Share> of_equal_cost(std::span<const double> costs, std::size_t shares) {
  std::vector<std::size_t> costliest_first(costs.size());
  std::iota(costliest_first.begin(), costliest_first.end(), std::size_t{0});
  std::ranges::stable_sort(costliest_first, std::greater<>(),
                           [&](std::size_t task) { return costs[task]; });
  using Load = std::pair<double, std::size_t>;
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
  for (std::size_t share = 0; share < shares; ++share) loads.emplace(0.0, share);
  std::vector<Share> divided(shares);
  for (const std::size_t task : costliest_first) {
    const auto [cost, share] = loads.top();
    loads.pop();
    loads.emplace(cost + costs[task], share);
    divided[share].push_back(task);
  }
  for (Share& share : divided) std::ranges::sort(share);
  return divided;
}

/// Divides tasks into messages of decreasing size. A producer can send about a thousand messages
/// before consumers have to wait for it. Therefore each message has three quarters of a consumer's
/// share of the remaining tasks, but at least a fifth of its share of all tasks. A message has at
/// most a 1,024th of all tasks, so that even with few consumers, little is lost when one fails.
std::vector<Share> falling(std::size_t tasks, std::size_t consumers) {
  const std::size_t most = std::max<std::size_t>(1, tasks / 1024);
  const std::size_t least = std::clamp<std::size_t>(tasks / (5 * consumers), 1, most);
  std::vector<Share> divided;
  for (std::size_t next = 0; next < tasks;) {
    const std::size_t size = std::clamp(3 * (tasks - next) / (4 * consumers), least, most);
    for (std::size_t i = 0; i < consumers && next < tasks; ++i) {
      Share& share = divided.emplace_back(std::min(size, tasks - next));
      std::iota(share.begin(), share.end(), next);
      next += share.size();
    }
  }
  return divided;
}

}  // namespace

std::string_view name_of(Work work) {
  for (const auto& [name, named] : kNames) {
    if (named == work) return name;
  }
  throw std::logic_error("work without a name");
}

std::optional<Work> work_named(std::string_view name) {
  for (const auto& [known, work] : kNames) {
    if (known == name) return work;
  }
  return std::nullopt;
}

bool is_static(Work work) {
  return work != Work::kBeams && work != Work::kBlocks && work != Work::kTiles;
}

std::vector<accel::beam::PixelRect> blocks_of(int width, int height, int block_width,
                                              int block_height) {
  std::vector<accel::beam::PixelRect> blocks;
  for (int top = 0; top < height; top += block_height) {
    for (int left = 0; left < width; left += block_width) {
      blocks.push_back(
          {left, top, std::min(block_width, width - left), std::min(block_height, height - top)});
    }
  }
  return blocks;
}

TileOrder::TileOrder(int width, int height, int size)
    : width_(width),
      height_(height),
      size_(size),
      columns_(static_cast<std::size_t>((width + size - 1) / size)),
      rows_(static_cast<std::size_t>((height + size - 1) / size)) {
  const auto part = [](double of_all, std::size_t count) {
    return static_cast<std::size_t>(of_all * static_cast<double>(count));
  };
  step_ = part(0.7548776662, rows_) * columns_ + part(0.5698402910, columns_);
  while (std::gcd(step_, count()) != 1) ++step_;  // otherwise some tiles would never be reached
}

accel::beam::PixelRect TileOrder::operator[](std::size_t i) const {
  const std::size_t number = i * step_ % count();
  const int left = static_cast<int>(number % columns_) * size_;
  const int top = static_cast<int>(number / columns_) * size_;
  return {left, top, std::min(size_, width_ - left), std::min(size_, height_ - top)};
}

std::vector<Share> divide(ImageDivision division, std::size_t tasks, const Among& among) {
  const auto shares = static_cast<std::size_t>(among.consumers);
  const auto divided = [&] {
    switch (division) {
      case ImageDivision::kContiguous:
        return contiguous(tasks, shares);
      case ImageDivision::kInterlaced:
        return interlaced(tasks, shares);
      case ImageDivision::kEqualCost:
        return of_equal_cost(among.costs, shares);
      case ImageDivision::kBatches:
        return contiguous(tasks, (tasks + among.batch - 1) / among.batch);
      case ImageDivision::kFalling:
        return falling(tasks, shares);
    }
    throw std::logic_error("an unknown division");
  };
  std::vector<Share> all = divided();
  std::erase_if(all, [](const Share& share) { return share.empty(); });
  return all;
}

ImageDivision division_of(Work work) {
  switch (work) {
    case Work::kTiles:
      return ImageDivision::kFalling;
    case Work::kContiguous:
      return ImageDivision::kContiguous;
    case Work::kInterlaced:
    case Work::kWindows:
      return ImageDivision::kInterlaced;
    case Work::kPrePass:
      return ImageDivision::kEqualCost;
    default:
      throw std::logic_error("work that is not divided in advance");
  }
}

}  // namespace beambench::cluster
