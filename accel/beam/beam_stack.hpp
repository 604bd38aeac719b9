#pragma once
// Beams that wait to be traced.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/beam/beam.hpp"

namespace beambench::accel::beam {

/// A beam and what it meets.
struct BeamStep {
  BeamKind kind;
  Beam beam;
};

/// The last beam pushed is the next to be traced. Corners and cuts of all beams stand in one array
/// each, so that a beam takes no more memory than it uses, and none is allocated for one.
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

  /// Takes the last beam off. Not when empty.
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

  /// Takes the half off that was pushed first: the beams next to the eye, with most behind them.
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

}  // namespace beambench::accel::beam
