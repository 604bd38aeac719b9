#include "accel/beam/beam_options.hpp"

namespace beambench::accel::beam {

std::vector<ParameterInfo> BeamOptions::parameters() {
  std::vector<ParameterInfo> parameters = octree::OctreeOptions::parameters();
  parameters.push_back(integer_parameter(
      "handover", 0, 0, 1'000'000'000,
      "a beam of fewer samples than this becomes individual rays; 0 (thesis): never"));
  parameters.push_back(choice_parameter(
      "continue", "rays", {"rays", "beams"},
      "what passes an occupied leaf goes on as individual rays (thesis), or as a beam again "
      "(discussed and rejected in its section 3.6.2)"));
  parameters.push_back(flag_parameter(
      "share_corners", false,
      "with 5 samples a pixel: a corner is traced once for the pixels that share it"));
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
