// Words of command lines: structures, scenes, ray kinds and resolutions, with their parameters.

#include <string>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/measure/plan.hpp"
#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/catalogue.hpp"
#include "tests/fuzz/target.hpp"

namespace {

using namespace beambench;

/// Checks that a choice's label names the same choice.
void check_structures(std::string_view text) {
  const auto choices = fuzz::accepted([&] { return accel::registry().choose_list(text); });
  if (!choices) return;
  for (const accel::StructureChoice& choice : *choices) {
    for (const std::string& label : {choice.label(), choice.short_label()}) {
      const auto again = accel::registry().choose(parse_spec(label));
      fuzz::require(again.label() == choice.label(), "a label stands for another structure");
    }
  }
}

/// Parses the parameters of a generated scene without generating it, because it may be arbitrarily
/// large.
void check_scenes(std::string_view text) {
  const auto specs = fuzz::accepted([&] { return parse_spec_list(text); });
  if (!specs) return;
  for (const Spec& spec : *specs) {
    const auto label = fuzz::accepted([&] {
      const scenes::SceneInfo& scene = scenes::find_scene(spec.name);
      return Parameters(scene.name, scene.parameters, spec.parameters).label();
    });
    if (label) measure::shown_scene(*label);
  }
}

void check_rays(std::string_view text) {
  const auto choices = fuzz::accepted([&] { return rays::parse_ray_choices(text); });
  if (!choices) return;
  for (const rays::RayChoice& choice : *choices) {
    if (!choice.file.empty()) continue;  // its label is the file's name in printable form
    fuzz::require(rays::parse_ray_choice(choice.label) == choice, "a label stands for other rays");
  }
}

void check_resolution(std::string_view text) {
  const auto resolution = fuzz::accepted([&] { return rays::parse_resolution(text); });
  if (!resolution) return;
  fuzz::require(rays::parse_resolution(rays::to_string(*resolution)) == *resolution,
                "a resolution is written differently");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::text_of(data, size);
  check_structures(text);
  check_scenes(text);
  check_rays(text);
  check_resolution(text);
  scenes::is_scene_file(text);
  return 0;
}
