#include "accel/bvh/insertion_hierarchy.hpp"

#include <algorithm>
#include <array>

#include "accel/core/padded_bounds.hpp"

namespace beambench::accel::bvh {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Objects that are direct children of a volume, as a list through `next_object_`.
struct ObjectList {
  std::uint32_t first = kNone;
  double smallest = kNever;  ///< no object in the list has a smaller area
};

/// A bounding volume during the growth of the hierarchy.
struct Volume {
  scenes::Bounds box;
  double area = 0.0;
  std::uint32_t children = 0;          ///< volumes and objects
  std::uint32_t first_volume = kNone;  ///< its first child volume; `next` links the others
  std::uint32_t next = kNone;
  /// Objects with less than half the volume's area on insertion, and larger objects. Pairing an
  /// object with a child of at least half the area in a new volume costs more than adding a child,
  /// so the search skips thousands of large objects in one place.
  std::array<ObjectList, 2> objects{};
};

/// A candidate place for an object, and its cost.
struct Choice {
  enum class Kind { kChild, kBesideObject, kBesideVolume };

  double cost = kNever;
  Kind kind = Kind::kChild;
  std::uint32_t volume = 0;      ///< gets the child, or is where the new volume goes
  std::uint32_t list = 0;        ///< for kBesideObject: the partner's list
  std::uint32_t before = kNone;  ///< for kBesideObject: the object before the partner
  std::size_t depth = 0;         ///< number of volumes on the path that grow
};

class Inserter {
 public:
  Inserter(std::span<const scenes::Bounds> boxes, Insertion insertion)
      : boxes_(boxes), insertion_(insertion), next_object_(boxes.size(), kNone) {}

  void insert(scenes::PrimitiveId object) {
    if (volumes_.empty()) {
      volumes_.push_back({.box = boxes_[object], .area = half_area(boxes_[object])});
      add_object(0, object);
      return;
    }
    object_ = object;
    object_area_ = half_area(boxes_[object]);
    place(insertion_ == Insertion::kTerminal ? find_terminal() : find_cheapest());
  }

  /// Returns the finished hierarchy. It is not recursive, because the depth of volumes is
  /// unlimited.
  InsertionHierarchy finish() const {
    InsertionHierarchy hierarchy;
    hierarchy.volumes = volumes_.size();
    hierarchy.boxes_weighed = boxes_weighed_;
    auto& entries = hierarchy.entries;
    entries.reserve(volumes_.size() + boxes_.size());
    std::vector<std::uint32_t> open;      // entries whose end is still unknown
    std::vector<std::uint32_t> siblings;  // the volume to visit next on each level
    if (!volumes_.empty()) siblings.push_back(0);
    while (!siblings.empty()) {
      const std::uint32_t index = siblings.back();
      if (index == kNone) {
        siblings.pop_back();
        if (open.empty()) break;
        entries[open.back()].end = static_cast<std::uint32_t>(entries.size());
        open.pop_back();
        continue;
      }
      const Volume& volume = volumes_[index];
      siblings.back() = volume.next;
      open.push_back(static_cast<std::uint32_t>(entries.size()));
      entries.push_back({volume.box, 0, scenes::kNoPrimitive});
      append_objects(volume, entries);
      siblings.push_back(volume.first_volume);
      hierarchy.depth = std::max<std::uint64_t>(hierarchy.depth, open.size());
      hierarchy.widest = std::max<std::uint64_t>(hierarchy.widest, volume.children);
    }
    hierarchy.cost = hierarchy_cost(entries);
    return hierarchy;
  }

 private:
  double area_with_object(const scenes::Bounds& box) {
    ++boxes_weighed_;
    return half_area(united(box, boxes_[object_]));
  }

  Choice find_cheapest() {
    path_.clear();
    Choice best;
    std::uint32_t index = 0;
    double area = area_with_object(volumes_[0].box);  // the volume's area with the object
    double inherited = 0.0;                           // cost of enlarging the volumes above
    while (true) {
      const Volume& volume = volumes_[index];
      const auto offer = [&](double cost, Choice::Kind kind, std::size_t depth) {
        if (cost >= best.cost) return;
        best = {.cost = cost, .kind = kind, .volume = index, .depth = depth};
      };
      offer(inherited + 2.0 * area, Choice::Kind::kBesideVolume, path_.size());
      path_.push_back(index);
      inherited += volume.children * (area - volume.area);
      offer(inherited + area, Choice::Kind::kChild, path_.size());
      offer_objects(index, inherited, best);
      if (inherited + object_area_ >= best.cost) return best;
      index = least_growing(volume, area);
      if (index == kNone) return best;
    }
  }

  /// Evaluates pairing the object with each object of the volume.
  void offer_objects(std::uint32_t index, double inherited, Choice& best) {
    const Volume& volume = volumes_[index];
    for (std::uint32_t list = 0; list < volume.objects.size(); ++list) {
      const ObjectList& objects = volume.objects[list];
      if (inherited + 2.0 * std::max(objects.smallest, object_area_) >= best.cost) continue;
      std::uint32_t before = kNone;
      for (std::uint32_t partner = objects.first; partner != kNone;
           before = partner, partner = next_object_[partner]) {
        const double cost = inherited + 2.0 * area_with_object(boxes_[partner]);
        if (cost >= best.cost) continue;
        best = {cost, Choice::Kind::kBesideObject, index, list, before, path_.size()};
      }
    }
  }

  /// Finds the place beside the terminal node at the end of the path of least growth.
  Choice find_terminal() {
    path_.clear();
    std::uint32_t index = 0;
    double area = area_with_object(volumes_[0].box);  // the volume's area with the object
    while (true) {
      path_.push_back(index);
      const Volume& volume = volumes_[index];
      double below = 0.0;
      const std::uint32_t child = least_growing(volume, below);
      const double growth = child == kNone ? kNever : below - volumes_[child].area;
      const Choice terminal = least_growing_object(index, growth, below);
      if (terminal.cost == kNever) {
        index = child;
        area = below;
        continue;
      }
      // The volumes on the path grow equally in both cases.
      if (terminal.cost < area) return terminal;
      return {.cost = area, .kind = Choice::Kind::kChild, .volume = index, .depth = path_.size()};
    }
  }

  /// Finds the object of a volume whose box grows least when paired with the new object. It must
  /// grow by less than `growth`, or by as much but to an area below `area`; otherwise the cost is
  /// kNever.
  Choice least_growing_object(std::uint32_t index, double growth, double area) {
    Choice best;
    for (std::uint32_t list = 0; list < volumes_[index].objects.size(); ++list) {
      std::uint32_t before = kNone;
      for (std::uint32_t partner = volumes_[index].objects[list].first; partner != kNone;
           before = partner, partner = next_object_[partner]) {
        const double grown = area_with_object(boxes_[partner]);
        const double by = grown - half_area(boxes_[partner]);
        if (by > growth || (by == growth && grown >= area)) continue;
        growth = by;
        area = grown;
        best = {2.0 * grown, Choice::Kind::kBesideObject, index, list, before, path_.size()};
      }
    }
    return best;
  }

  /// Returns the child volume whose area grows least (of several, the smallest) and sets its new
  /// area.
  std::uint32_t least_growing(const Volume& volume, double& area) {
    std::uint32_t best = kNone;
    double least = kNever;
    for (std::uint32_t child = volume.first_volume; child != kNone; child = volumes_[child].next) {
      const double grown = area_with_object(volumes_[child].box);
      const double growth = grown - volumes_[child].area;
      if (growth < least || (growth == least && grown < area)) {
        least = growth;
        area = grown;
        best = child;
      }
    }
    return best;
  }

  void place(const Choice& choice) {
    for (std::size_t i = 0; i < choice.depth; ++i) {
      Volume& volume = volumes_[path_[i]];
      volume.box.include(boxes_[object_]);
      volume.area = half_area(volume.box);
    }
    switch (choice.kind) {
      case Choice::Kind::kChild:
        add_object(choice.volume, object_);
        break;
      case Choice::Kind::kBesideObject: {
        const scenes::PrimitiveId partner = remove_object(choice);
        const std::uint32_t pair = add_volume(boxes_[partner]);
        add_object(pair, partner);
        add_object(pair, object_);
        add_child(choice.volume, pair);
        break;
      }
      case Choice::Kind::kBesideVolume: {
        // The new volume takes over the old one's number and thus its place in the parent's list.
        const Volume old = volumes_[choice.volume];
        const std::uint32_t moved = add_volume(old.box);
        volumes_[choice.volume] = volumes_[moved];
        volumes_[choice.volume].next = old.next;
        volumes_[moved] = old;
        add_child(choice.volume, moved);
        add_object(choice.volume, object_);
        break;
      }
    }
  }

  /// Adds a volume without children, around a box and the object.
  std::uint32_t add_volume(const scenes::Bounds& box) {
    const scenes::Bounds both = united(box, boxes_[object_]);
    volumes_.push_back({.box = both, .area = half_area(both)});
    return static_cast<std::uint32_t>(volumes_.size() - 1);
  }

  void add_child(std::uint32_t parent, std::uint32_t child) {
    volumes_[child].next = volumes_[parent].first_volume;
    volumes_[parent].first_volume = child;
    ++volumes_[parent].children;
  }

  void add_object(std::uint32_t index, scenes::PrimitiveId object) {
    Volume& volume = volumes_[index];
    const double area = half_area(boxes_[object]);
    ObjectList& list = volume.objects[2.0 * area < volume.area ? 0 : 1];
    next_object_[object] = list.first;
    list.first = object;
    list.smallest = std::min(list.smallest, area);
    ++volume.children;
  }

  scenes::PrimitiveId remove_object(const Choice& choice) {
    Volume& volume = volumes_[choice.volume];
    std::uint32_t& link =
        choice.before == kNone ? volume.objects[choice.list].first : next_object_[choice.before];
    const scenes::PrimitiveId removed = link;
    link = next_object_[removed];
    --volume.children;
    return removed;
  }

  void append_objects(const Volume& volume, std::vector<HierarchyEntry>& entries) const {
    for (const ObjectList& list : volume.objects) {
      for (std::uint32_t object = list.first; object != kNone; object = next_object_[object]) {
        entries.push_back({boxes_[object], static_cast<std::uint32_t>(entries.size() + 1), object});
      }
    }
  }

  std::span<const scenes::Bounds> boxes_;
  Insertion insertion_;
  std::vector<std::uint32_t> next_object_;
  std::vector<Volume> volumes_;                        ///< the root is the first
  std::vector<std::uint32_t> path_;                    ///< volumes entered by the search
  scenes::PrimitiveId object_ = scenes::kNoPrimitive;  ///< the object being inserted
  double object_area_ = 0.0;
  std::uint64_t boxes_weighed_ = 0;
};

}  // namespace

double hierarchy_cost(std::span<const HierarchyEntry> entries) {
  double sum = 0.0;
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    if (!entries[i].is_volume()) continue;
    const double area = half_area(entries[i].box);
    for (std::uint32_t child = i + 1; child < entries[i].end; child = entries[child].end) {
      sum += area;
    }
  }
  return entries.empty() ? 0.0 : sum / half_area(entries.front().box);
}

InsertionHierarchy build_by_insertion(std::span<const scenes::Bounds> boxes,
                                      std::span<const scenes::PrimitiveId> order,
                                      Insertion insertion) {
  Inserter inserter(boxes, insertion);
  for (const scenes::PrimitiveId object : order) inserter.insert(object);
  return inserter.finish();
}

}  // namespace beambench::accel::bvh
