#include "accel/beam/beam_options.hpp"

namespace beambench::accel::beam {

std::vector<ParameterInfo> BeamRules::parameters(const BeamRules& defaults) {
  return {integer_parameter(
              "handover", defaults.handover, 0, 1'000'000'000,
              "a beam of fewer samples than this becomes individual rays; 0 (thesis): never"),
          choice_parameter(
              "continue", defaults.continue_with_rays ? "rays" : "beams", {"rays", "beams"},
              "what passes an occupied leaf continues as individual rays (thesis), or as a beam "
              "again (discussed and rejected in its section 3.6.2)"),
          flag_parameter("share_corners", defaults.share_corners,
                         "with 5 samples per pixel: a corner is traced once for the pixels that "
                         "share it")};
}

BeamRules BeamRules::from(const Parameters& parameters) {
  BeamRules rules;
  rules.handover = parameters.integer("handover");
  rules.continue_with_rays = parameters.choice("continue") == "rays";
  rules.share_corners = parameters.flag("share_corners");
  return rules;
}

}  // namespace beambench::accel::beam
