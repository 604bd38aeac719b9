#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "accel/core/image_accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/polygon_beam/beam_tree.hpp"

namespace beambench::accel::polygon_beam {
namespace {

constexpr const char* kName = "polygon-beam";

/// The beam tracer of Heckbert and Hanrahan ("Beam tracing polygonal objects", SIGGRAPH 1984): an
/// image is one beam, which polygons cut from front to back. It traces only images of polygons: the
/// coherence of a list of rays is unknown.
class PolygonBeam : public ImageAccelerator, public Inspector {
 public:
  PolygonBeam(const scenes::Scene& scene, const TreeOptions& options)
      : ImageAccelerator(kName), scene_(&scene), tree_(scene, options) {}

  /// Traces an image. Each beam depends on those before it, so one thread traces all of them.
  void closest_hits(const RaySource& rays, const HitSpan& hits,
                    const QueryContext& context) const override {
    const PrimaryRays& image = image_of(rays);
    with_counting(context.counters, [&]<class Counting>(Counting& counting) {
      count(BeamTree<Counting>(*scene_, tree_, image, hits, counting, nullptr).trace(), counting);
    });
  }

  Statistics statistics() const override {
    Statistics statistics;
    statistics.nodes = tree_.nodes().size();
    for (const TreeNode& node : tree_.nodes()) {
      if (!node.is_leaf) continue;
      ++statistics.leaves;
      statistics.empty_leaves += node.count == 0 ? 1 : 0;
    }
    statistics.references = tree_.fragments().size();
    statistics.depth = tree_.depth();
    statistics.bytes = sizeof(*this) + tree_.bytes();
    statistics.image_rays = ImageRays::kOwn;
    return statistics;
  }

  const Inspector* inspector() const override { return this; }
  /// Returns the beams that polygons ended, in the order in which they ended, with the samples that
  /// the polygons hide; then the beams that nothing ended. Samples on edges are in several beams.
  std::optional<std::vector<BeamOutline>> beams(const PrimaryRays& image) const override {
    std::vector<BeamOutline> outlines;
    HitBuffer hits(image.width(), image.height(), image.samples());
    NoCounting counting;
    BeamTree<NoCounting>(*scene_, tree_, image, hits, counting, &outlines).trace();
    return outlines;
  }

 private:
  template <class Counting>
  static void count(const BeamSums& sums, Counting& counting) {
    counting.add("beams", sums.ended + sums.left);
    counting.add("beams_ended", sums.ended);
    counting.add("beams_leaving", sums.left);
    counting.add("beams_made", sums.made);
    counting.add("beams_dropped", sums.dropped);
    counting.add("beam_clips", sums.clips);
    counting.add("polygons_met", sums.met);
    counting.add("samples_in_beams", sums.confirmed);
    counting.add("samples_on_edges", sums.undecided);
  }

  const scenes::Scene* scene_;
  PolygonTree tree_;
};

std::vector<ParameterInfo> parameters() {
  const TreeOptions defaults;
  return {integer_parameter("max_polygons", static_cast<std::int64_t>(defaults.max_polygons), 1,
                            1'000'000,
                            "a cell with more triangles, not counting those in its faces, is "
                            "divided"),
          integer_parameter("max_depth", static_cast<std::int64_t>(defaults.max_depth), 0, 48,
                            "maximum number of divisions of a cell"),
          integer_parameter("max_references", static_cast<std::int64_t>(defaults.max_references), 1,
                            2'000'000'000,
                            "refuse trees with more fragments of triangles (16 bytes each, plus 24 "
                            "for each corner if a plane cut them)")};
}

TreeOptions options_from(const Parameters& parameters) {
  TreeOptions options;
  options.max_polygons = static_cast<std::size_t>(parameters.integer("max_polygons"));
  options.max_depth = static_cast<std::size_t>(parameters.integer("max_depth"));
  options.max_references = static_cast<std::uint64_t>(parameters.integer("max_references"));
  return options;
}

}  // namespace

void register_polygon_beam(Registry& registry) {
  registry.add({kName,
                "beam tracing of polygons as one beam per image, which polygons cut from front to "
                "back in the order of a BSP tree (Heckbert and Hanrahan 1984); images only",
                Conformance::kBitExact,
                parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<PolygonBeam>(scene, options_from(parameters));
                },
                {.single_rays = false, .batches = false, .spheres = false, .cones = false}});
  registry.describe_counters(
      kName,
      {{"beams", "beams that a polygon ended, and beams that met no other polygon"},
       {"beams_ended", "of these: ended by a polygon that hides everything behind it"},
       {"beams_leaving",
        "of these: ended by no polygon; they contain the background and "
        "samples on edges"},
       {"beams_made",
        "the beam of the whole image, and each remaining part of a beam that was cut"},
       {"beams_dropped", "remaining parts of beams without samples"},
       {"beam_clips", "cuts of a polygon by a line"},
       {"polygons_met", "triangles that samples of a beam may hit, for each beam and leaf"},
       {"samples_in_beams", "samples in beams that a polygon ended"},
       {"samples_on_edges", "samples that hit something and are in beams that nothing ended"}});
}

}  // namespace beambench::accel::polygon_beam
