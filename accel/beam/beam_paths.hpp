#pragma once
// Beams through the octree: where they begin, how they continue behind an empty leaf, and the stack
// of pending beams.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/beam/beam.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"

namespace beambench::accel::beam {

/// A beam and the node that it enters.
struct BeamStep {
  BeamKind kind;
  Beam beam;
};

/// A stack of beams. The corners and cuts of all beams are stored in one array each, so that a beam
/// takes only the memory it needs and no separate allocation.
class BeamStack {
 public:
  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }

  void push(BeamKind kind, const Beam& beam) {
    entries_.push_back({kind, beam.node, beam.size, beam.corner,
                        static_cast<std::uint16_t>(beam.outline.size()),
                        static_cast<std::uint16_t>(beam.cuts.size())});
    corners_.insert(corners_.end(), beam.outline.begin(), beam.outline.end());
    cuts_.insert(cuts_.end(), beam.cuts.begin(), beam.cuts.end());
  }

  /// Removes the last beam. The stack must not be empty.
  void pop(BeamStep& step) {
    const Entry entry = entries_.back();
    entries_.pop_back();
    step.kind = entry.kind;
    step.beam.node = entry.node;
    step.beam.size = entry.size;
    step.beam.corner = entry.corner;
    take(corners_, entry.corners, step.beam.outline);
    take(cuts_, entry.cuts, step.beam.cuts);
  }

  /// Removes the half that was pushed first: the beams nearest to the camera, which have the most
  /// work ahead of them.
  BeamStack take_older_half() {
    const auto half = static_cast<std::ptrdiff_t>(entries_.size() / 2);
    std::ptrdiff_t corners = 0;
    std::ptrdiff_t cuts = 0;
    for (auto entry = entries_.begin(); entry != entries_.begin() + half; ++entry) {
      corners += entry->corners;
      cuts += entry->cuts;
    }
    BeamStack older;
    move_first(entries_, half, older.entries_);
    move_first(corners_, corners, older.corners_);
    move_first(cuts_, cuts, older.cuts_);
    return older;
  }

 private:
  struct Entry {
    BeamKind kind;
    std::uint32_t node;
    std::int32_t size;
    glm::ivec3 corner;
    std::uint16_t corners;
    std::uint16_t cuts;
  };

  template <class T, std::size_t Capacity>
  static void take(std::vector<T>& from, std::size_t count, FixedVector<T, Capacity>& to) {
    to.resize(count);
    std::copy(from.end() - static_cast<std::ptrdiff_t>(count), from.end(), to.begin());
    from.resize(from.size() - count);
  }

  template <class T>
  static void move_first(std::vector<T>& from, std::ptrdiff_t count, std::vector<T>& to) {
    to.assign(from.begin(), from.begin() + count);
    from.erase(from.begin(), from.begin() + count);
  }

  std::vector<Entry> entries_;
  std::vector<glm::dvec2> corners_;
  std::vector<BeamCut> cuts_;
};

/// Receives the beams that enter leaves of other parts if the octree is part of a larger one.
class BeamBorder {
 public:
  BeamBorder() = default;
  BeamBorder(const BeamBorder&) = delete;
  BeamBorder& operator=(const BeamBorder&) = delete;
  virtual ~BeamBorder() = default;
  /// Handles a beam that enters a leaf through a face. Returns whether it is taken; if so, it is
  /// not queued here.
  virtual bool takes(std::uint32_t leaf, const Crossing& face, const Beam& beam) = 0;
};

/// The nodes, of any size, that beams pass as if they were empty leaves, because they hold nothing
/// that the beams' rays could hit.
class PassedNodes {
 public:
  PassedNodes() = default;
  PassedNodes(const PassedNodes&) = delete;
  PassedNodes& operator=(const PassedNodes&) = delete;
  virtual ~PassedNodes() = default;
  virtual bool has(const octree::OctreeCursor& node) const = 0;
};

/// Pending beams, and counts of the work of finding them.
///
/// The thesis counts a beam when one is created: at the beginning, and for each part of a beam that
/// is cut. A beam that continues undivided is the same beam in another leaf (section 4.4.2:
/// `PasaPor` as opposed to the constructor; graphic 3.4: "the standard beam is not modified").
struct BeamQueue {
  BeamStack waiting;
  std::uint64_t clips = 0;
  std::uint64_t neighbor_searches = 0;
  std::uint64_t appended = 0;           ///< beams appended to `waiting` or taken at the border
  std::uint64_t made = 0;               ///< initial beams, and the parts of divided beams
  std::uint64_t divided = 0;            ///< beams that continued in several parts
  std::uint64_t passed_whole = 0;       ///< continued undivided into a leaf or out of the root
  BeamBorder* border = nullptr;         ///< null if the octree is not part of a larger one
  const PassedNodes* passed = nullptr;  ///< null if no nodes are passed
};

/// Appends the beams at which tracing begins (thesis, section 3.4), through a convex `part` of the
/// image; `view.screen()` is the whole image. From outside the root, there is a beam for each face
/// of the root that faces the camera: the part clipped to the face, divided among the leaves behind
/// it. From inside, the part itself begins in the leaf that contains the camera. Samples that
/// belong to no beam miss the root, or run along a plane of the grid that nearby rays may cross on
/// the other side of the eye.
void begin_beams(const octree::Octree& octree, const EyeView& view, const ImagePolygon& part,
                 BeamQueue& queue);

/// Appends the parts of a beam that leaves a leaf (thesis, section 3.5): it is divided among the
/// faces through which its rays leave, then among the leaves behind each face.
void continue_beam(const octree::Octree& octree, const EyeView& view, const Beam& beam,
                   BeamQueue& queue);

/// Appends a beam that enters a node through a face, divided among the node's leaves at that face.
void enter_node(const EyeView& view, const Crossing& face, const octree::OctreeCursor& node,
                const Beam& beam, BeamQueue& queue);

}  // namespace beambench::accel::beam
