#pragma once
// The tree of ray sets, divided as rays arrive.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <span>
#include <vector>

#include "accel/core/statistics.hpp"
#include "accel/ray_classification/hypercube.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::ray_classification {

struct RayTreeOptions {
  std::size_t max_candidates = 16;  ///< a set whose rays may meet more primitives is divided
  int max_depth = 25;               ///< maximum number of divisions of a set
  std::uint64_t max_references = 50'000'000;
};

struct Halves;

/// A set of rays and the primitives that they may meet, nearest first along the face's axis.
struct RaySet {
  std::vector<scenes::PrimitiveId> candidates;
  mutable std::atomic<const Halves*> halves{nullptr};
};

/// A divided set.
struct Halves {
  std::size_t dimension;
  double middle;
  std::array<RaySet, 2> sets;
};

/// The sets of one face, a binary tree over its five dimensions. When the first ray in a set
/// arrives, the set is divided in the middle of its largest dimension, and its candidates are
/// reclassified. The division does not depend on the order of rays, so neither do hits and
/// counters, unless the lists reach `max_references`: from then on no sets are divided, and rays
/// are tested against longer lists.
///
/// Several threads may query at once, as in `OnDemandOctree`.
class RayTree {
 public:
  /// A position in the tree: a set, its contents, and how often it was divided.
  struct Place {
    const RaySet* set;
    Hypercube rays;
    int depth;
    std::uint64_t code;  ///< 1, followed by a binary digit for each division
  };

  /// `boxes` are those of all primitives, widened for rounding; `whole` is the box of their union.
  /// `references` counts the list entries of all trees and must outlive this tree.
  RayTree(std::size_t face, const Box& whole, std::span<const Box> boxes,
          const RayTreeOptions& options, std::atomic<std::uint64_t>& references);
  RayTree(const RayTree&) = delete;
  RayTree& operator=(const RayTree&) = delete;

  const Face& face() const { return face_; }
  /// Returns the undivided set that contains a ray, dividing sets as necessary. Calls `visit(place,
  /// is_leaf)` for each set on the path.
  template <class Visit>
  Place find(const Point& ray, const Visit& visit) const {
    Place place{&root_, whole_, 0, 1};
    while (true) {
      const Halves* halves = halves_of(place);
      visit(place, halves == nullptr);
      if (halves == nullptr) return place;
      const bool is_upper = ray[halves->dimension] >= halves->middle;
      enter(*halves, is_upper, place);
    }
  }

  /// Adds the sets made so far to the statistics; those that may still be divided count as leaves.
  void describe(Statistics& statistics) const;
  /// Calls `visit(place)` for each leaf.
  template <class Visit>
  void for_each_leaf(const Visit& visit) const {
    std::vector<Place> open{{&root_, whole_, 0, 1}};
    while (!open.empty()) {
      const Place place = open.back();
      open.pop_back();
      const Halves* halves = place.set->halves.load(std::memory_order_acquire);
      if (halves == nullptr) {
        visit(place);
        continue;
      }
      for (const bool is_upper : {true, false}) {
        Place half = place;
        enter(*halves, is_upper, half);
        open.push_back(half);
      }
    }
  }

 private:
  static void enter(const Halves& halves, bool is_upper, Place& place) {
    place.set = &halves.sets[is_upper ? 1 : 0];
    Interval& interval = place.rays[halves.dimension];
    (is_upper ? interval.low : interval.high) = halves.middle;
    ++place.depth;
    place.code = 2 * place.code + (is_upper ? 1 : 0);
  }
  const Halves* halves_of(const Place& place) const {
    const Halves* halves = place.set->halves.load(std::memory_order_acquire);
    if (halves != nullptr || place.depth >= options_.max_depth ||
        place.set->candidates.size() <= options_.max_candidates) {
      return halves;
    }
    return divide(place);
  }
  /// Divides a set; returns nullptr if the lists are already too long.
  const Halves* divide(const Place& place) const;

  Face face_;
  RayTreeOptions options_;
  Hypercube whole_;
  std::vector<SeenBox> boxes_;
  RaySet root_;
  // Mutable because queries add divisions, the same ones whatever their order.
  mutable std::mutex publishing_;
  mutable std::deque<Halves> divided_;
  std::atomic<std::uint64_t>& references_;
};

}  // namespace beambench::accel::ray_classification
