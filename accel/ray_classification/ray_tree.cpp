#include "accel/ray_classification/ray_tree.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace beambench::accel::ray_classification {

RayTree::RayTree(std::size_t face, const Box& whole, std::span<const Box> boxes,
                 const RayTreeOptions& options, std::atomic<std::uint64_t>& references)
    : face_(Face::of(face)), options_(options), references_(references) {
  boxes_.reserve(boxes.size());
  for (const Box& box : boxes) boxes_.emplace_back(face_, box);
  const SeenBox seen(face_, whole);
  whole_ = {seen.along, seen.aside[0], seen.aside[1], {-1.0, 1.0}, {-1.0, 1.0}};
  root_.candidates.resize(boxes.size());
  std::iota(root_.candidates.begin(), root_.candidates.end(), scenes::PrimitiveId{0});
  std::ranges::stable_sort(root_.candidates, {},
                           [&](scenes::PrimitiveId id) { return boxes_[id].along.low; });
  references_.fetch_add(boxes.size(), std::memory_order_relaxed);
}

const Halves* RayTree::divide(const Place& place) const {
  if (references_.load(std::memory_order_relaxed) >= options_.max_references) return nullptr;
  const std::size_t dimension = widest_dimension(place.rays, whole_);
  const Interval& interval = place.rays[dimension];
  const double middle = interval.low + 0.5 * interval.size();
  std::array<std::vector<scenes::PrimitiveId>, 2> lists;
  for (std::size_t half = 0; half < 2; ++half) {
    Hypercube rays = place.rays;
    (half == 0 ? rays[dimension].high : rays[dimension].low) = middle;
    for (const scenes::PrimitiveId id : place.set->candidates) {
      if (may_meet(rays, boxes_[id])) lists[half].push_back(id);
    }
    lists[half].shrink_to_fit();
  }
  const std::lock_guard lock(publishing_);
  if (const Halves* earlier = place.set->halves.load(std::memory_order_acquire)) return earlier;
  references_.fetch_add(lists[0].size() + lists[1].size(), std::memory_order_relaxed);
  Halves& made = divided_.emplace_back();
  made.dimension = dimension;
  made.middle = middle;
  for (std::size_t half = 0; half < 2; ++half) {
    made.sets[half].candidates = std::move(lists[half]);
  }
  place.set->halves.store(&made, std::memory_order_release);
  return &made;
}

void RayTree::describe(Statistics& statistics) const {
  const std::lock_guard lock(publishing_);
  statistics.nodes += 1 + 2 * divided_.size();
  statistics.bytes += sizeof(*this) + boxes_.capacity() * sizeof(SeenBox) +
                      root_.candidates.capacity() * sizeof(scenes::PrimitiveId);
  for (const Halves& halves : divided_) {
    statistics.bytes += sizeof halves;
    for (const RaySet& set : halves.sets) {
      statistics.bytes += set.candidates.capacity() * sizeof(scenes::PrimitiveId);
    }
  }
  for_each_leaf([&](const Place& place) {
    ++statistics.leaves;
    if (place.set->candidates.empty()) ++statistics.empty_leaves;
    statistics.references += place.set->candidates.size();
    statistics.depth = std::max(statistics.depth, static_cast<std::uint64_t>(place.depth) + 1);
  });
}

}  // namespace beambench::accel::ray_classification
