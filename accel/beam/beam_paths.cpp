#include "accel/beam/beam_paths.hpp"

#include "accel/octree/octree_cursor.hpp"

namespace beambench {
namespace {

/// A beam on its way into what lies behind a face that all its rays cross.
class Entry {
 public:
  Entry(const EyeView& view, const Crossing& face, BeamQueue& queue)
      : view_(&view), face_(face), queue_(&queue) {}

  /// Divides a beam that enters the cursor's node by the face among the node's leaves there
  /// (thesis, section 3.5.2.3) and appends them.
  void divide(const OctreeCursor& cursor, const Beam& beam) const {
    if (cursor.node().is_leaf()) {
      append(cursor, beam);
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
        OctreeCursor child = cursor;
        child.enter_child(corner);
        divide(child, part);
      });
    });
  }

 private:
  /// Calls `visit(part, above)` for the parts of a beam that cross the face below and above a plane
  /// of another axis.
  template <class Visit>
  void halve(const Beam& beam, int axis, std::int32_t index, Visit visit) const {
    const Crossing middle = view_->crossing_of(axis, index);
    const ImageLine line = view_->line_before(middle, face_);
    const LineRange range = range_over(beam.outline, line);
    // Who crosses the middle plane first is on its far side when crossing the face.
    const bool far_is_above = middle.side > 0;
    if (range.high <= kSliver) {
      visit(beam, far_is_above);
    } else if (range.low >= -kSliver) {
      visit(beam, !far_is_above);
    } else {
      queue_->clips += 2;
      Beam far_part = beam;
      cut(far_part, middle, face_, line);
      drop_needless_cuts(far_part);
      visit(far_part, far_is_above);
      Beam near_part = beam;
      cut(near_part, face_, middle, line.turned());
      drop_needless_cuts(near_part);
      visit(near_part, !far_is_above);
    }
  }

  void append(const OctreeCursor& leaf, const Beam& beam) const {
    if (beam.outline.empty()) return;
    queue_->steps.push_back(
        {leaf.node().count == 0 ? BeamKind::kNonTerminal : BeamKind::kOccupied, beam});
    Beam& entered = queue_->steps.back().beam;
    entered.node = leaf.index();
    entered.corner = leaf.corner();
    entered.size = leaf.size();
  }

  const EyeView* view_;
  Crossing face_;
  BeamQueue* queue_;
};

/// Keeps of a beam what crosses `inner` before `outer`, unless all of it does.
void keep(const EyeView& view, const Crossing& inner, const Crossing& outer, Beam& beam,
          BeamQueue& queue) {
  if (beam.outline.empty()) return;
  const ImageLine line = view.line_before(inner, outer);
  if (range_over(beam.outline, line).high < -kSliver) return;
  ++queue.clips;
  cut(beam, inner, outer, line);
}

void enter_root(const Octree& octree, const EyeView& view, const Crossing& face,
                BeamQueue& queue) {
  Beam beam{};
  beam.outline = view.screen();
  for (int other = 1; other <= 2; ++other) {
    const int axis = (face.axis + other) % 3;
    const Crossing lower = view.crossing_of(axis, 0);
    const Crossing upper = view.crossing_of(axis, octree.grid().cells[axis]);
    // When crossing the face, a ray is beyond the planes that it crossed before.
    lower.side > 0 ? keep(view, lower, face, beam, queue) : keep(view, face, lower, beam, queue);
    upper.side > 0 ? keep(view, face, upper, beam, queue) : keep(view, upper, face, beam, queue);
  }
  if (beam.outline.empty()) return;
  drop_needless_cuts(beam);
  Entry(view, face, queue).divide(OctreeCursor(octree), beam);
}

/// The planes by which rays can leave a leaf: those of its faces that the eye is not beyond.
FixedVector<Crossing, 6> exits(const EyeView& view, const Beam& beam) {
  FixedVector<Crossing, 6> found;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const Crossing face{beam.corner[axis] + (side > 0 ? beam.size : 0),
                          static_cast<std::int8_t>(axis), static_cast<std::int8_t>(side)};
      if (view.distance(face) >= 0.0) found.push_back(face);
    }
  }
  return found;
}

/// Leaves out the exits that get no more than a sliver of the beam. The exits that are left divide
/// all samples among them, for of two exits that are compared one always stays.
void drop_slivers(const EyeView& view, const Beam& beam, FixedVector<Crossing, 6>& exits) {
  for (std::size_t i = 0; i < exits.size(); ++i) {
    for (std::size_t j = i + 1; j < exits.size();) {
      const LineRange range = range_over(beam.outline, view.line_before(exits[i], exits[j]));
      const bool drop_i = range.low >= -kSliver;
      const bool drop_j = !drop_i && range.high <= kSliver;
      if (!drop_i && !drop_j) {
        ++j;
        continue;
      }
      const std::size_t dropped = drop_i ? i : j;
      for (std::size_t k = dropped + 1; k < exits.size(); ++k) exits[k - 1] = exits[k];
      exits.resize(exits.size() - 1);
      if (drop_i) j = i + 1;  // another exit stands at i now
    }
  }
}

}  // namespace

void begin_beams(const Octree& octree, const EyeView& view, BeamQueue& queue) {
  bool inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t cells = octree.grid().cells[axis];
    const double at = view.eye()[axis];
    const bool below = at < octree.grid().plane(axis, 0);
    const bool above = at > octree.grid().plane(axis, cells);
    if (!below && !above) continue;
    inside = false;
    const Crossing face{below ? 0 : cells, static_cast<std::int8_t>(axis),
                        static_cast<std::int8_t>(below ? 1 : -1)};
    enter_root(octree, view, face, queue);
  }
  if (!inside) return;
  OctreeCursor cursor(octree);
  while (!cursor.node().is_leaf()) {
    glm::ivec3 corner = cursor.corner();
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t middle = corner[axis] + cursor.size() / 2;
      if (octree.grid().plane(axis, middle) <= view.eye()[axis]) corner[axis] = middle;
    }
    cursor.enter_child(corner);
  }
  Beam beam{};
  beam.outline = view.screen();
  beam.node = cursor.index();
  beam.corner = cursor.corner();
  beam.size = cursor.size();
  queue.steps.push_back(
      {cursor.node().count == 0 ? BeamKind::kNonTerminal : BeamKind::kOccupied, beam});
}

void continue_beam(const Octree& octree, const EyeView& view, const Beam& beam, BeamQueue& queue) {
  auto faces = exits(view, beam);
  drop_slivers(view, beam, faces);
  for (const Crossing& face : faces) {
    Beam part = beam;
    for (const Crossing& other : faces) {
      if (&other == &face || part.outline.empty()) continue;
      ++queue.clips;
      cut(part, face, other, view.line_before(face, other));
    }
    if (part.outline.empty()) continue;
    if (faces.size() > 1) drop_needless_cuts(part);

    OctreeCursor cursor(octree);
    cursor.jump(beam.node, beam.corner, beam.size);
    glm::ivec3 step(0);
    step[face.axis] = face.side;
    ++queue.neighbour_searches;
    if (cursor.move_to_neighbour(step) == 0) {
      queue.steps.push_back({BeamKind::kLeaving, part});
    } else {
      Entry(view, face, queue).divide(cursor, part);
    }
  }
}

}  // namespace beambench
