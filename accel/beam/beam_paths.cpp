#include "accel/beam/beam_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace beambench::accel::beam {
namespace {

/// What a beam meets in a node; nothing where it is to be divided among the node's children.
std::optional<BeamKind> met_in(const octree::OctreeCursor& cursor, const BeamQueue& queue) {
  if (cursor.node().count == 0) return BeamKind::kNonTerminal;
  if (queue.passed != nullptr && queue.passed->has(cursor)) return BeamKind::kNonTerminal;
  if (cursor.node().is_leaf()) return BeamKind::kOccupied;
  return std::nullopt;
}

void push_at(const octree::OctreeCursor& cursor, BeamKind kind, Beam beam, BeamQueue& queue) {
  beam.node = cursor.index();
  beam.corner = cursor.corner();
  beam.size = cursor.size();
  queue.waiting.push(kind, beam);
}

/// Counts a beam that continued in that many parts.
void count_parts(std::uint64_t parts, BeamQueue& queue) {
  if (parts == 1) {
    ++queue.passed_whole;
  } else if (parts > 1) {
    ++queue.divided;
    queue.made += parts;
  }
}

/// Divides a beam among the leaves behind a face that all its rays cross.
class Entry {
 public:
  Entry(const EyeView& view, const Crossing& face, BeamQueue& queue)
      : view_(&view), face_(face), queue_(&queue) {}

  /// Divides a beam that enters the cursor's node by the face among the node's leaves there
  /// (thesis, section 3.5.2.3) and appends them.
  void divide(const octree::OctreeCursor& cursor, const Beam& beam) const {
    if (beam.outline.empty()) return;
    if (const auto kind = met_in(cursor, *queue_)) {
      append(cursor, *kind, beam);
      return;
    }
    const int u = (face_.axis + 1) % 3;
    const int v = (face_.axis + 2) % 3;
    const std::int32_t half = cursor.size() / 2;
    halve(beam, u, cursor.corner()[u] + half, [&](const Beam& strip, bool above_u) {
      halve(strip, v, cursor.corner()[v] + half, [&](const Beam& part, bool above_v) {
        glm::ivec3 corner = cursor.corner();
        if (face_.side < 0) corner[face_.axis] += half;
        if (above_u) corner[u] += half;
        if (above_v) corner[v] += half;
        octree::OctreeCursor child = cursor;
        child.enter_child(corner);
        divide(child, part);
      });
    });
  }

 private:
  /// Calls `visit(part, above)` for the parts of a beam that cross the face below and above a plane
  /// of another axis. Both are empty where all of the beam lies within the margin of nearby rays.
  template <class Visit>
  void halve(const Beam& beam, int axis, std::int32_t index, Visit visit) const {
    if (beam.outline.empty()) return;
    const Crossing middle = view_->crossing_of(axis, index);
    const ImageLine line = view_->line_before(middle, face_);
    const LineRange range = range_over(beam.outline, line);
    // Rays that cross the middle plane first are on its far side when they cross the face.
    const bool far_is_above = middle.side > 0;
    if (view_->all_before(range)) {
      visit(beam, far_is_above);
    } else if (view_->all_behind(range)) {
      visit(beam, !far_is_above);
    } else {
      queue_->clips += 2;
      const std::array<BeamCut, 2> sides{BeamCut{middle, face_, line},
                                         BeamCut{face_, middle, view_->other_side(line)}};
      visit(part_of(beam, {&sides[0], 1}), far_is_above);
      visit(part_of(beam, {&sides[1], 1}), !far_is_above);
    }
  }

  void append(const octree::OctreeCursor& cursor, BeamKind kind, const Beam& beam) const {
    ++queue_->appended;
    if (queue_->border != nullptr && queue_->border->takes(cursor.index(), face_, beam)) return;
    push_at(cursor, kind, beam, *queue_);
  }

  const EyeView* view_;
  Crossing face_;
  BeamQueue* queue_;
};

/// A cut between the rays that cross `inner` first and those that cross `outer` first.
BeamCut cut_between(const EyeView& view, const Crossing& inner, const Crossing& outer) {
  return {inner, outer, view.line_before(inner, outer)};
}

void enter_root(const octree::Octree& octree, const EyeView& view, const Beam& screen,
                const Crossing& face, BeamQueue& queue) {
  FixedVector<BeamCut, 4> borders;
  for (int other = 1; other <= 2; ++other) {
    const int axis = (face.axis + other) % 3;
    const Crossing lower = view.crossing_of(axis, 0);
    const Crossing upper = view.crossing_of(axis, octree.grid().cells[axis]);
    // When crossing the face, a ray is beyond the planes that it crossed before.
    borders.push_back(lower.side > 0 ? cut_between(view, lower, face)
                                     : cut_between(view, face, lower));
    borders.push_back(upper.side > 0 ? cut_between(view, face, upper)
                                     : cut_between(view, upper, face));
  }
  queue.clips += borders.size();
  const Beam beam = part_of(screen, {borders.begin(), borders.size()});
  Entry(view, face, queue).divide(octree::OctreeCursor(octree), beam);
}

/// The faces by which a beam leaves its leaf, and the lines on the image between them.
///
/// The thesis finds the exit directions by the zones of the main face's plane and, in its conflict
/// corners, by a second plane (section 3.5.1). Comparing the faces two by two is the same for all
/// zones. Each line is made once and serves the faces on both of its sides.
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

  /// The cuts around the part of the beam that leaves by face i.
  FixedVector<BeamCut, 5> cuts(const EyeView& view, std::size_t i) const {
    FixedVector<BeamCut, 5> cuts;
    for (std::size_t j = 0; j < faces_.size(); ++j) {
      if (j < i) cuts.push_back({faces_[i], faces_[j], view.other_side(lines_[j][i])});
      if (j > i) cuts.push_back({faces_[i], faces_[j], lines_[i][j]});
    }
    return cuts;
  }

 private:
  /// Adds a face unless one of the others leaves it no more than a sliver of the beam, and removes
  /// those to which it leaves no more. One of two that are compared always stays, so the remaining
  /// faces divide all samples among them.
  void add(const EyeView& view, const Beam& beam, const Crossing& face) {
    std::array<ImageLine, 6> lines{};
    for (std::size_t i = 0; i < faces_.size();) {
      lines[i] = view.line_before(faces_[i], face);
      const LineRange range = range_over(beam.outline, lines[i]);
      if (view.all_before(range)) return;
      if (view.all_behind(range)) {
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

void begin_at(const octree::Octree& octree, const EyeView& view, const Beam& screen,
              BeamQueue& queue) {
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t cells = octree.grid().cells[axis];
    const double at = view.eye(axis);
    const bool below = at < octree.grid().plane(axis, 0);
    const bool above = at > octree.grid().plane(axis, cells);
    if (!below && !above) continue;
    inside = false;
    const Crossing face{below ? 0 : cells, static_cast<std::int16_t>(axis),
                        static_cast<std::int16_t>(below ? 1 : -1)};
    enter_root(octree, view, screen, face, queue);
  }
  if (!inside) return;
  octree::OctreeCursor cursor(octree);
  std::optional<BeamKind> kind;
  while (!(kind = met_in(cursor, queue))) {
    glm::ivec3 corner = cursor.corner();
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t middle = corner[axis] + cursor.size() / 2;
      if (octree.grid().plane(axis, middle) <= view.eye(axis)) corner[axis] = middle;
    }
    cursor.enter_child(corner);
  }
  push_at(cursor, *kind, screen, queue);
  ++queue.appended;
}

/// The plane of the grid nearest to the eye, crossed toward `side`.
Crossing nearest_plane(const octree::Octree& octree, const EyeView& view, int axis, int side) {
  const CellGrid& grid = octree.grid();
  const double cells = (view.eye(axis) - grid.lower[axis]) / grid.cell[axis];
  return {static_cast<std::int32_t>(
              std::clamp(std::round(cells), 0.0, static_cast<double>(grid.cells[axis]))),
          static_cast<std::int16_t>(axis), static_cast<std::int16_t>(side)};
}

/// Begins a beam, divided by the planes beside the eye, from this axis on: rays that run along such
/// a plane may be on the other side of it than the eye, and are in none of the parts.
void begin_beside_planes(const octree::Octree& octree, const EyeView& view, int axis,
                         const Beam& screen, BeamQueue& queue) {
  if (screen.outline.empty()) return;
  if (axis == 3) return begin_at(octree, view, screen, queue);
  const Crossing upward = nearest_plane(octree, view, axis, 1);
  if (!view.eye_is_beside(upward)) {
    return begin_beside_planes(octree, view, axis + 1, screen, queue);
  }
  const Crossing downward = nearest_plane(octree, view, axis, -1);
  for (const BeamCut& side : {BeamCut{upward, downward, view.line_toward(upward)},
                              BeamCut{downward, upward, view.line_toward(downward)}}) {
    begin_beside_planes(octree, view, axis + 1, part_of(screen, {&side, 1}), queue);
  }
}

}  // namespace

void begin_beams(const octree::Octree& octree, const EyeView& view, const ImagePolygon& part,
                 BeamQueue& queue) {
  const std::uint64_t before = queue.appended;
  Beam screen;
  screen.outline = part;
  begin_beside_planes(octree, view, 0, screen, queue);
  queue.made += queue.appended - before;
}

void continue_beam(const octree::Octree& octree, const EyeView& view, const Beam& beam,
                   BeamQueue& queue) {
  const std::uint64_t before = queue.appended;
  const Exits exits(view, beam);
  for (std::size_t i = 0; i < exits.count(); ++i) {
    const auto cuts = exits.cuts(view, i);
    queue.clips += cuts.size();
    const Beam part = part_of(beam, {cuts.begin(), cuts.size()});
    if (part.outline.empty()) continue;

    const Crossing& face = exits.face(i);
    octree::OctreeCursor cursor(octree);
    cursor.jump(beam.node, beam.corner, beam.size);
    glm::ivec3 step(0);
    step[face.axis] = face.side;
    ++queue.neighbor_searches;
    if (cursor.move_to_neighbor(step) == 0) {
      queue.waiting.push(BeamKind::kLeaving, part);
      ++queue.appended;
    } else {
      Entry(view, face, queue).divide(cursor, part);
    }
  }
  count_parts(queue.appended - before, queue);
}

void enter_node(const EyeView& view, const Crossing& face, const octree::OctreeCursor& node,
                const Beam& beam, BeamQueue& queue) {
  Entry(view, face, queue).divide(node, beam);
}

}  // namespace beambench::accel::beam
