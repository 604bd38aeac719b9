#include <hwy/targets.h>

#include "accel/beam/beam_options.hpp"

namespace beambench::accel::beam {
namespace {

std::string name_of(LeafTest leaf) {
  if (leaf == LeafTest::kSimd) return "simd";
  return leaf == LeafTest::kScalar ? "scalar" : "exact";
}

LeafTest leaf_test(const std::string& name) {
  if (name == name_of(LeafTest::kSimd)) return LeafTest::kSimd;
  return name == name_of(LeafTest::kScalar) ? LeafTest::kScalar : LeafTest::kExact;
}

}  // namespace

const ProbeKernels* kernels_of(LeafTest leaf) {
  if (leaf == LeafTest::kSimd) return &simd_probe_kernels();
  return leaf == LeafTest::kScalar ? &scalar_probe_kernels() : nullptr;
}

std::string instruction_set_of(LeafTest leaf) {
  return leaf == LeafTest::kSimd ? hwy::TargetName(simd_probe_kernels().target) : "";
}

std::vector<ParameterInfo> BeamRules::parameters(const BeamRules& defaults) {
  return {integer_parameter(
              "handover", defaults.handover, 0, 1'000'000'000,
              "a beam with fewer samples than this becomes individual rays; 0 (thesis): never"),
          choice_parameter(
              "continue", defaults.continue_with_rays ? "rays" : "beams", {"rays", "beams"},
              "how samples continue behind an occupied leaf: as individual rays (thesis), or "
              "again as a beam (discussed and rejected in its section 3.6.2)"),
          flag_parameter("share_corners", defaults.share_corners,
                         "with 5 samples per pixel: trace a corner only once for the pixels "
                         "that share it"),
          choice_parameter(
              "leaf", name_of(defaults.leaf),
              {name_of(LeafTest::kSimd), name_of(LeafTest::kScalar), name_of(LeafTest::kExact)},
              "how samples are tested in an occupied leaf; the hits are the same: against the "
              "primitives' images on the screen by SIMD, against these by scalar code, or each by "
              "the canonical test, without images. The thesis compares programs that share their "
              "tests (7.2.2), so its claims compare like for like with exact")};
}

BeamRules BeamRules::from(const Parameters& parameters) {
  BeamRules rules;
  rules.handover = parameters.integer("handover");
  rules.continue_with_rays = parameters.choice("continue") == "rays";
  rules.share_corners = parameters.flag("share_corners");
  rules.leaf = leaf_test(parameters.choice("leaf"));
  return rules;
}

}  // namespace beambench::accel::beam
