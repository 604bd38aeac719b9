#include "accel/beam/beam_cost.hpp"
#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/core/registry.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"

namespace beambench::accel::beam {

namespace {

octree::Octree chosen_octree(const scenes::Scene& scene, const BeamOptions& options,
                             const Workload& workload) {
  const auto handover = static_cast<double>(options.handover);
  return octree::choose_octree(
      scene, options.octree, workload,
      [handover](const octree::OctreeWork& work) { return beam_trace_cost(work, handover); },
      [&](const octree::Octree& octree, const octree::OctreeWork& expected,
          octree::OctreeWork& work) { count_beams(octree, workload, expected, work); });
}

/// As accel/beam/README.md explains them.
std::vector<CounterInfo> beam_counters() {
  return {
      {"beams", "leaves entered by a beam, and beams that leave the root"},
      {"beams_nonterminal", "of these: empty leaves"},
      {"beams_occupied", "of these: occupied leaves, where the beam's samples become rays"},
      {"beams_leaving", "of these: beams that leave the root"},
      {"beams_nonterminal_ns", "nanoseconds of the counting pass spent in empty leaves"},
      {"beams_occupied_ns", "nanoseconds of the counting pass spent in occupied leaves"},
      {"beams_leaving_ns", "nanoseconds of the counting pass spent on beams that leave the root"},
      {"beams_made",
       "beams as the thesis counts them: those at the beginning, and each part of a "
       "beam that is cut"},
      {"beams_divided", "beams that were cut into two parts or more"},
      {"beams_passed_whole", "times that a beam continued undivided"},
      {"beam_edges", "edges of the polygons of all beams"},
      {"beam_clips", "cuts of a polygon by a line"},
      {"neighbor_searches", "searches of the leaf behind a face, by beams"},
      {std::string(octree::kNeighborSteps), std::string(octree::kNeighborStepsMeaning)},
      {std::string(octree::kLastClimb), std::string(octree::kLastClimbMeaning)},
      {"samples_leaving", "samples that left the root with a beam"},
      {"samples_in_leaves", "samples that were tested in a leaf with a beam"},
      {"rays_after_leaf", "samples that found no hit in their beam's leaf and continued as rays"},
      {"rays_by_handover",
       "samples that became rays because their beam had fewer than 'handover', or few of a "
       "mirror's"},
      {"rays_by_crowding", "samples that became rays because their beam had too many cuts"},
  };
}

}  // namespace

void register_beam(Registry& registry) {
  registry.add(
      {"beam",
       "the beam tracer of the thesis: primary rays, and what planar mirrors show, in beams "
       "through "
       "samet's octree, individual rays where a beam meets objects",
       Conformance::kBitExact, BeamOptions::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         const BeamOptions options = BeamOptions::from(parameters);
         return std::make_unique<BeamTracer>(scene, chosen_octree(scene, options, workload),
                                             options);
       }});
  registry.describe_counters("beam", beam_counters());
}

std::vector<ParameterInfo> BeamOptions::parameters() {
  std::vector<ParameterInfo> parameters = octree::OctreeOptions::parameters();
  parameters.push_back(integer_parameter(
      "handover", 0, 0, 1'000'000'000,
      "a beam of fewer samples than this becomes individual rays; 0 (thesis): never"));
  parameters.push_back(choice_parameter(
      "continue", "rays", {"rays", "beams"},
      "what passes an occupied leaf continues as individual rays (thesis), or as a beam again "
      "(discussed and rejected in its section 3.6.2)"));
  parameters.push_back(flag_parameter(
      "share_corners", false,
      "with 5 samples per pixel: a corner is traced once for the pixels that share it"));
  return parameters;
}

BeamOptions BeamOptions::from(const Parameters& parameters) {
  BeamOptions options;
  options.octree = octree::OctreeOptions::from(parameters);
  options.handover = parameters.integer("handover");
  options.continue_with_rays = parameters.choice("continue") == "rays";
  options.share_corners = parameters.flag("share_corners");
  return options;
}

}  // namespace beambench::accel::beam
