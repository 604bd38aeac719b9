#include "accel/beam/beam_paths.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "accel/beam/beam_division.hpp"

namespace beambench::accel::beam {
namespace {

/// Returns what a beam meets in a node; nothing if it must be divided among the node's children.
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

/// Divides a beam among the leaves behind a face crossed by all its rays.
class Entry {
 public:
  Entry(const EyeView& view, const Crossing& face, BeamQueue& queue)
      : view_(&view), face_(face), queue_(&queue) {}

  /// Divides a beam that enters the cursor's node through the face among the node's leaves at that
  /// face (thesis, section 3.5.2.3) and appends the parts.
  void divide(const octree::OctreeCursor& cursor, const Beam& beam) const {
    if (beam.outline.empty()) return;
    if (const auto kind = met_in(cursor, *queue_)) {
      append(cursor, *kind, beam);
      return;
    }
    const int u = (face_.axis + 1) % 3;
    const int v = (face_.axis + 2) % 3;
    const std::int32_t half = cursor.size() / 2;
    halve(*view_, face_, u, cursor.corner()[u] + half, beam, *queue_,
          [&](const Beam& strip, bool above_u) {
            halve(*view_, face_, v, cursor.corner()[v] + half, strip, *queue_,
                  [&](const Beam& part, bool above_v) {
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
  void append(const octree::OctreeCursor& cursor, BeamKind kind, const Beam& beam) const {
    ++queue_->appended;
    if (queue_->border != nullptr && queue_->border->takes(cursor.index(), face_, beam)) return;
    push_at(cursor, kind, beam, *queue_);
  }

  const EyeView* view_;
  Crossing face_;
  BeamQueue* queue_;
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
    Entry(view, face, queue)
        .divide(octree::OctreeCursor(octree), part_entering(view, face, screen, queue));
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

/// Returns the crossing, toward `side`, of the grid plane nearest to the eye.
Crossing nearest_plane(const octree::Octree& octree, const EyeView& view, int axis, int side) {
  const CellGrid& grid = octree.grid();
  const double cells = (view.eye(axis) - grid.lower[axis]) / grid.cell[axis];
  return {static_cast<std::int32_t>(
              std::clamp(std::round(cells), 0.0, static_cast<double>(grid.cells[axis]))),
          static_cast<std::int16_t>(axis), static_cast<std::int16_t>(side)};
}

/// Begins a beam, divided by the planes next to the eye, across this axis and those after it. Rays
/// along such a plane may be on the side opposite the eye; no part contains them.
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
    const auto cuts = exits.cuts(i);
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
