#pragma once
// Beams that wait to be traced.

#include <cstdint>
#include <vector>

#include "accel/beam/beam.hpp"

namespace beambench {

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

  std::vector<Entry> entries_;
  std::vector<glm::dvec2> corners_;
  std::vector<BeamCut> cuts_;
};

}  // namespace beambench
