#pragma once
// Individual rays through Goldsmith and Salmon's hierarchy of bounding volumes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "accel/bvh/insertion_hierarchy.hpp"
#include "accel/core/intersect.hpp"
#include "accel/core/slab_ray.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "accel/core/tree_quality.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::accel::bvh {

/// Options for building and traversing the hierarchy.
struct GoldsmithSalmonOptions {
  enum class Order { kGiven, kShuffled, kSorted };
  enum class Queue { kHeap, kStack };

  Order order = Order::kGiven;  ///< sorted: by center along the scene's longest axis
  std::uint64_t seed = 1;       ///< seed of the shuffle
  Queue queue = Queue::kHeap;
  Insertion insertion = Insertion::kEverywhere;

  static std::vector<ParameterInfo> parameters();
  static GoldsmithSalmonOptions from(const Parameters& parameters);
};

/// An entry of the hierarchy that a ray meets, and the t at which it enters the entry's box.
struct MetEntry {
  float enter;
  std::uint32_t index;
};

struct Farther {
  bool operator()(const MetEntry& a, const MetEntry& b) const { return a.enter > b.enter; }
};

/// The entries that a ray still has to visit, nearest first across the whole hierarchy: the
/// priority queue of Kay and Kajiya (1986; thesis, graphic 4.1).
class NearestFirstQueue {
 public:
  explicit NearestFirstQueue(std::pmr::memory_resource* memory) : entries_(memory) {
    entries_.reserve(kUsual);
  }

  bool empty() const { return entries_.empty(); }
  void push(const MetEntry& entry) {
    entries_.push_back(entry);
    std::push_heap(entries_.begin(), entries_.end(), Farther{});
  }
  /// All entries in the queue are at least as far away as the one returned.
  static constexpr bool kOrdered = true;
  MetEntry pop() {
    std::pop_heap(entries_.begin(), entries_.end(), Farther{});
    const MetEntry nearest = entries_.back();
    entries_.pop_back();
    return nearest;
  }
  void end_of_siblings() {}

  /// The initial capacity: most rays never have as many entries pending at a time.
  static constexpr std::size_t kUsual = 128;

 private:
  std::pmr::vector<MetEntry> entries_;
};

/// The same entries in depth-first order: nearest first among the children of one volume.
class OrderedStack {
 public:
  explicit OrderedStack(std::pmr::memory_resource* memory) : entries_(memory) {
    entries_.reserve(NearestFirstQueue::kUsual);
  }

  bool empty() const { return entries_.empty(); }
  void push(const MetEntry& entry) { entries_.push_back(entry); }
  static constexpr bool kOrdered = false;
  MetEntry pop() {
    const MetEntry last = entries_.back();
    entries_.pop_back();
    sorted_ = entries_.size();
    return last;
  }
  /// Sorts the entries pushed since the last pop.
  void end_of_siblings() {
    const auto first = entries_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    std::sort(first, entries_.end(), Farther{});
  }

 private:
  std::pmr::vector<MetEntry> entries_;
  std::size_t sorted_ = 0;
};

/// A hierarchy built by Goldsmith and Salmon's insertion, traversed with Kay and Kajiya's queue for
/// the closest hit and by plain depth-first search for any hit. Volumes and objects each have a
/// box, which is tested before the volume or object is entered. With `Insertion::kTerminal`, this
/// is the hierarchy of the thesis (sections 4.3 and 5.4.2).
class GoldsmithSalmon : public TraversalAccelerator<GoldsmithSalmon>, public BoxHierarchy {
 public:
  GoldsmithSalmon(const scenes::Scene& scene, const GoldsmithSalmonOptions& options);

  const InsertionHierarchy& hierarchy() const { return hierarchy_; }
  Statistics statistics() const override;
  bool update(const scenes::Scene& scene) override;
  void describe(TreeQuality& tree) const override;

  template <class Counting>
  std::optional<Hit> find_closest(const Ray& ray, Counting& counting) const {
    return queue_ == GoldsmithSalmonOptions::Queue::kHeap
               ? closest_through<NearestFirstQueue>(ray, counting)
               : closest_through<OrderedStack>(ray, counting);
  }

  /// Traverses in preorder, skipping missed entries: the recursion of the thesis's graphic 4.2
  /// without its stack.
  template <class Counting>
  bool find_any(const Ray& ray, Counting& counting) const {
    const CanonicalRay canonical(ray);
    const SlabRay slabs(ray);
    const auto& entries = hierarchy_.entries;
    for (std::uint32_t index = 0; index < entries.size();) {
      const HierarchyEntry& entry = entries[index];
      counting.add(Counter::kBoxTests);
      if (slabs.interval(entry.box, ray.t_min, ray.t_max).empty()) {
        index = entry.end;
        continue;
      }
      ++index;
      if (entry.is_volume()) {
        counting.add(Counter::kTraversalSteps);
        continue;
      }
      counting.add_tests(scene_->primitives[entry.primitive].kind);
      if (is_hit(intersect(canonical, *scene_, entry.primitive))) return true;
    }
    return false;
  }

 private:
  template <class Queue, class Counting>
  std::optional<Hit> closest_through(const Ray& ray, Counting& counting) const {
    const auto& entries = hierarchy_.entries;
    if (entries.empty()) return std::nullopt;
    std::array<std::byte, NearestFirstQueue::kUsual * sizeof(MetEntry)> usual;
    std::pmr::monotonic_buffer_resource memory(usual.data(), usual.size());
    Queue queue(&memory);
    ClosestHit closest(ray);
    const SlabRay slabs(ray);
    const auto push_if_met = [&](std::uint32_t index) __attribute__((always_inline)) {
      counting.add(Counter::kBoxTests);
      const BoxInterval met = slabs.interval(entries[index].box, ray.t_min, closest.ray.t_max);
      if (!met.empty()) queue.push({met.enter, index});
    };

    push_if_met(0);
    while (!queue.empty()) {
      const MetEntry met = queue.pop();
      // Strictly greater: at the same t, a primitive with a lower id may still be found.
      if (met.enter > closest.ray.t_max) {
        if (Queue::kOrdered) break;
        continue;
      }
      const HierarchyEntry& entry = entries[met.index];
      if (!entry.is_volume()) {
        counting.add_tests(scene_->primitives[entry.primitive].kind);
        counting.tested(entry.primitive, closest.test(*scene_, entry.primitive));
        continue;
      }
      counting.add(Counter::kTraversalSteps);
      counting.enter([&] {
        return TraceStep{.place = "volume",
                         .index = met.index,
                         .box = Box{glm::dvec3(entry.box.lower), glm::dvec3(entry.box.upper)},
                         .t_enter = met.enter,
                         .t_exit = slabs.interval(entry.box, ray.t_min, ray.t_max).exit};
      });
      for (std::uint32_t child = met.index + 1; child < entry.end; child = entries[child].end) {
        push_if_met(child);
      }
      queue.end_of_siblings();
    }
    return closest.result();
  }

  const scenes::Scene* scene_;
  GoldsmithSalmonOptions::Queue queue_;
  InsertionHierarchy hierarchy_;
};

}  // namespace beambench::accel::bvh
