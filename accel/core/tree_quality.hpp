#pragma once
// Estimates the quality of a hierarchy of boxes by one cost model for all structures.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// Computes two figures of a hierarchy, by the cost model of Aila, Karras and Laine ("On quality
/// metrics of bounding volume hierarchies", 2013): 0.6 for testing the box of each child of an
/// interior node (hence their 1.2 for a binary node) and 1 for testing each primitive of a leaf.
/// - `sah_cost`: the costs of all nodes, weighted by their areas over that of the root;
/// - `epo` (end-point overlap): the costs of all nodes, weighted by the share of the scene's
///   surface that lies in their boxes but does not belong to the primitives below them.
///
/// The hierarchy is described from the root down: `open` a node, describe its children or add the
/// primitives of a leaf, `close` it.
class TreeQuality {
 public:
  void open(const scenes::Bounds& box);
  void add_primitive(scenes::PrimitiveId id) { primitives_.push_back(id); }
  void close();

  bool empty() const { return entries_.empty(); }
  double sah_cost() const;
  /// Returns the end-point overlap, exact for polygons in scenes of at most `kMostSamples`
  /// primitives. In larger scenes, that many primitives are sampled at equal steps of their
  /// cumulative area. The surfaces of spheres and cones are represented by `kSolidPoints` points.
  double epo(const scenes::Scene& scene) const;

  static constexpr std::size_t kMostSamples = 4096;
  static constexpr std::size_t kSolidPoints = 256;

  /// A node in preorder.
  struct Entry {
    scenes::Bounds box;
    std::uint32_t end = 0;       ///< index just past its subtree
    std::uint32_t children = 0;  ///< 0 for a leaf
    std::size_t first = 0;       ///< the subtree's first position in the list of primitives
    std::size_t last = 0;        ///< just past the subtree's last position

    double cost() const;
  };
  /// Returns all nodes in preorder.
  std::span<const Entry> entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> open_;  ///< entries from the root to the node being described
  std::vector<scenes::PrimitiveId> primitives_;
};

/// A structure that is a hierarchy of boxes; a second base class beside `Accelerator`.
class BoxHierarchy {
 public:
  BoxHierarchy() = default;
  BoxHierarchy(const BoxHierarchy&) = delete;
  BoxHierarchy& operator=(const BoxHierarchy&) = delete;
  virtual ~BoxHierarchy() = default;

  /// Describes all nodes, if any.
  virtual void describe(TreeQuality& tree) const = 0;
};

/// Adds `sah_cost` and `epo` to the statistics of a structure over `scene` if it is a
/// `BoxHierarchy`. Takes up to a second for a million primitives, so `statistics()` omits them.
void append_quality(const Accelerator& structure, const scenes::Scene& scene,
                    Statistics& statistics);

}  // namespace beambench::accel
