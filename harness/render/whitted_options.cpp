#include "harness/render/whitted_options.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

constexpr std::array<std::string_view, 3> kNames{"rays", "cache", "light-buffer"};

}  // namespace

std::span<const std::string_view> shadow_method_names() { return kNames; }

ShadowMethod parse_shadow_method(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw InputError(
        fmt::format("unknown shadow method '{}'; choose from: {}", name, fmt::join(kNames, ", ")));
  }
  return static_cast<ShadowMethod>(found - kNames.begin());
}

WhittedOptions whitted_options(const rays::RayChoice& choice) {
  const rays::RayKindInfo& info = rays::info_of(rays::RayKind::kWhitted);
  const Parameters parameters(info.name, info.parameters, parse_spec(choice.label).parameters);
  return {static_cast<int>(parameters.integer("depth")), parameters.real("least_weight"),
          parse_shadow_method(parameters.choice("shadows"))};
}

}  // namespace beambench::render
