#pragma once
// The ways of beams through the octree: where they begin, and how they go on behind an empty leaf.

#include <cstdint>

#include "accel/beam/beam.hpp"
#include "accel/beam/beam_stack.hpp"
#include "accel/octree/octree.hpp"
#include "accel/octree/octree_cursor.hpp"

namespace beambench::accel::beam {

/// Where an octree is only a part of one: takes beams that come to leaves of others.
class BeamBorder {
 public:
  BeamBorder() = default;
  BeamBorder(const BeamBorder&) = delete;
  BeamBorder& operator=(const BeamBorder&) = delete;
  virtual ~BeamBorder() = default;
  /// A beam enters a leaf by a face. Returns whether it is taken, and waits no more here.
  virtual bool takes(std::uint32_t leaf, const Crossing& face, const Beam& beam) = 0;
};

/// Beams that wait to be traced, and what finding them took.
///
/// The thesis counts a beam when one is created: at the beginning, and for each part of a beam that
/// is cut. A beam that goes on whole is the same beam in another leaf (section 4.4.2: `PasaPor`
/// against the constructor; graphic 3.4: "the standard beam is not modified").
struct BeamQueue {
  BeamStack waiting;
  std::uint64_t clips = 0;
  std::uint64_t neighbor_searches = 0;
  std::uint64_t appended = 0;      ///< to `waiting`, or taken at the border
  std::uint64_t made = 0;          ///< those at the beginning, and the parts of divided beams
  std::uint64_t divided = 0;       ///< beams that went on in several parts
  std::uint64_t passed_whole = 0;  ///< beams that went on undivided: into one leaf, or out
  BeamBorder* border = nullptr;    ///< where there is one
};

/// Appends the beams at which tracing begins (thesis, section 3.4), through a convex `part` of the
/// image: the whole of it is `view.screen()`. From outside: for each face of the root that the eye
/// sees, the part clipped to it, divided among the leaves behind it. From inside: the part itself
/// in the eye's leaf. Samples of no beam miss the root.
void begin_beams(const octree::Octree& octree, const EyeView& view, const ImagePolygon& part,
                 BeamQueue& queue);

/// Appends the beams that leave a leaf (thesis, section 3.5): divided among the faces by which its
/// rays leave, then among the leaves behind each face.
void continue_beam(const octree::Octree& octree, const EyeView& view, const Beam& beam,
                   BeamQueue& queue);

/// Appends a beam that enters a node by a face, divided among the node's leaves there.
void enter_node(const EyeView& view, const Crossing& face, const octree::OctreeCursor& node,
                const Beam& beam, BeamQueue& queue);

}  // namespace beambench::accel::beam
