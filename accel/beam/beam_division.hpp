#pragma once
// Divides beams: among the faces through which they leave a cell, and by planes behind a face.

#include <array>
#include <cstddef>
#include <cstdint>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/crossing.hpp"

namespace beambench::accel::beam {

/// Counts a beam that continued in `parts` parts.
inline void count_parts(std::uint64_t parts, BeamQueue& queue) {
  if (parts == 1) {
    ++queue.passed_whole;
  } else if (parts > 1) {
    ++queue.divided;
    queue.made += parts;
  }
}

/// Calls `visit(part, above)` for the parts of a beam that cross a face below and above a plane of
/// another axis. All rays of the beam must cross the face.
template <class Visit>
void halve(const EyeView& view, const Crossing& face, int axis, std::int32_t index,
           const Beam& beam, BeamQueue& queue, Visit visit) {
  if (beam.outline.empty()) return;
  const Crossing middle = view.crossing_of(axis, index);
  const ImageLine line = view.line_before(middle, face);
  const LineRange range = range_over(beam.outline, line);
  // Rays that cross the middle plane first are on its far side when they cross the face.
  const bool far_is_above = middle.side > 0;
  if (EyeView::all_before(line, range)) {
    visit(beam, far_is_above);
  } else if (EyeView::all_behind(range)) {
    visit(beam, !far_is_above);
  } else {
    queue.clips += 2;
    const std::array<BeamCut, 2> sides{BeamCut{middle, face, line},
                                       BeamCut{face, middle, EyeView::other_side(line)}};
    visit(part_of(beam, {&sides[0], 1}), far_is_above);
    visit(part_of(beam, {&sides[1], 1}), !far_is_above);
  }
}

/// Returns the cut between the rays that cross `inner` first and those that cross `outer` first.
inline BeamCut cut_between(const EyeView& view, const Crossing& inner, const Crossing& outer) {
  return {inner, outer, view.line_before(inner, outer)};
}

/// Returns the part of a beam that enters the box of all cells through one of its faces (thesis,
/// section 3.4).
inline Beam part_entering(const EyeView& view, const Crossing& face, const Beam& screen,
                          BeamQueue& queue) {
  FixedVector<BeamCut, 4> borders;
  for (int other = 1; other <= 2; ++other) {
    const int axis = (face.axis + other) % 3;
    const Crossing lower = view.crossing_of(axis, 0);
    const Crossing upper = view.crossing_of(axis, view.grid().cells[axis]);
    // A ray that crosses the face is beyond the planes that it has already crossed.
    borders.push_back(lower.side > 0 ? cut_between(view, lower, face)
                                     : cut_between(view, face, lower));
    borders.push_back(upper.side > 0 ? cut_between(view, face, upper)
                                     : cut_between(view, upper, face));
  }
  queue.clips += borders.size();
  return part_of(screen, {borders.begin(), borders.size()});
}

/// The faces through which a beam leaves its leaf, and the lines on the image between them.
///
/// The thesis finds the exit directions by the zones of the main face's plane and, in its conflict
/// corners, by a second plane (section 3.5.1). Comparing the faces in pairs works the same way in
/// all zones. Each line is computed once and used for the faces on both of its sides.
class Exits {
 public:
  Exits(const EyeView& view, const Beam& beam) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) {
        const Crossing face{beam.corner[axis] + (side > 0 ? beam.size : 0),
                            static_cast<std::int16_t>(axis), static_cast<std::int16_t>(side)};
        // No ray leaves through a face whose plane the eye is already beyond.
        if (view.distance(face) >= 0.0) add(view, beam, face);
      }
    }
  }

  std::size_t count() const { return faces_.size(); }
  const Crossing& face(std::size_t i) const { return faces_[i]; }

  /// Returns the cuts around the part of the beam that leaves through face i.
  FixedVector<BeamCut, 5> cuts(std::size_t i) const {
    FixedVector<BeamCut, 5> cuts;
    for (std::size_t j = 0; j < faces_.size(); ++j) {
      if (j < i) cuts.push_back({faces_[i], faces_[j], EyeView::other_side(lines_[j][i])});
      if (j > i) cuts.push_back({faces_[i], faces_[j], lines_[i][j]});
    }
    return cuts;
  }

 private:
  /// Adds a face unless another face leaves it at most a sliver of the beam, and removes the faces
  /// to which it leaves at most a sliver. Each comparison drops at most one of the two faces, so
  /// the remaining faces divide all samples among them.
  void add(const EyeView& view, const Beam& beam, const Crossing& face) {
    std::array<ImageLine, 6> lines{};
    for (std::size_t i = 0; i < faces_.size();) {
      lines[i] = view.line_before(faces_[i], face);
      const LineRange range = range_over(beam.outline, lines[i]);
      if (EyeView::all_before(lines[i], range)) return;
      if (EyeView::all_behind(range)) {
        take_away(i);
      } else {
        ++i;
      }
    }
    for (std::size_t i = 0; i < faces_.size(); ++i) lines_[i][faces_.size()] = lines[i];
    faces_.push_back(face);
  }

  void take_away(std::size_t gone) {
    for (std::size_t i = gone + 1; i < faces_.size(); ++i) {
      faces_[i - 1] = faces_[i];
      for (std::size_t j = 0; j < faces_.size(); ++j) {
        if (j < gone) lines_[j][i - 1] = lines_[j][i];
        if (j > i) lines_[i - 1][j - 1] = lines_[i][j];
      }
    }
    faces_.resize(faces_.size() - 1);
  }

  FixedVector<Crossing, 6> faces_;
  std::array<std::array<ImageLine, 6>, 6> lines_;  ///< [i][j]: between faces i and j, i < j
};

}  // namespace beambench::accel::beam
