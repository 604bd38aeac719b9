#pragma once
// Shows a structure's work, for `beambench trace`, pictures and counts.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "accel/core/beam_passage.hpp"
#include "accel/core/beam_place.hpp"
#include "accel/core/cell.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_source.hpp"
#include "accel/core/trace_step.hpp"

namespace beambench::accel {

/// The traversal path of one sample of an image.
struct SampleSteps {
  std::vector<BeamPassage> beams;  ///< the beams that contain the sample, first to last
  std::vector<TraceStep> steps;    ///< cells whose references were tested, with each test
};

/// A node of a hierarchy, numbered as `TraceStep::index`.
struct NodeFacts {
  std::size_t parent;        ///< listed before the node; the root is its own parent
  bool is_leaf;              ///< otherwise an interior node
  std::uint64_t references;  ///< of a leaf
};

/// The optional part of the contract of a structure. Each method has a default for structures that
/// lack the feature. Calls are never timed; they are const and safe from several threads.
class [[gnu::visibility("default")]] Inspector {
 public:
  Inspector() = default;
  Inspector(const Inspector&) = delete;
  Inspector& operator=(const Inspector&) = delete;

  /// Returns the traversal path of a single ray, step by step; empty if none is recorded.
  virtual std::vector<TraceStep> path(const Ray&) const { return {}; }
  /// Returns the path of a sample of an image as a query of the whole image traces it: with the
  /// beams that contain the sample if the structure has beams; otherwise as a single ray. (x, y) is
  /// the pixel, (0, 0) at the top left; `sample` is the sample's number in the pixel.
  virtual SampleSteps path(const PrimaryRays& image, int x, int y, int sample) const {
    return {{}, path(image.ray(x, y, sample))};
  }

  /// Returns the cells that hold references; empty if the structure has no cells.
  virtual std::vector<Cell> occupied_cells() const { return {}; }
  /// Returns all nodes, the root first; empty if trace steps do not number them.
  virtual std::vector<NodeFacts> nodes() const { return {}; }

  /// Returns the beams of an image in the order in which they are traced; nothing if the structure
  /// has no beams.
  virtual std::optional<std::vector<BeamOutline>> beams(const PrimaryRays&) const {
    return std::nullopt;
  }
  /// Returns the place of each ray of an image as `closest_hits` traces it, or of a batch as
  /// `any_hits` does; empty if the structure has no blocks of rays.
  virtual std::vector<BeamPlace> places(const RaySource&) const { return {}; }

 protected:
  /// Protected: an inspector is owned by its structure.
  ~Inspector() = default;
};

}  // namespace beambench::accel
