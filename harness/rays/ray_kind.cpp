#include "harness/rays/ray_kind.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/error.hpp"

namespace beambench {
namespace {

constexpr std::array<RayKindInfo, 1> kRayKinds{
    {{RayKind::kPrimary, "primary", "from the camera through every sample of every pixel"}}};

}  // namespace

std::span<const RayKindInfo> ray_kinds() { return kRayKinds; }

std::string_view to_string(RayKind kind) { return kRayKinds[static_cast<std::size_t>(kind)].name; }

RayKind parse_ray_kind(std::string_view name) {
  for (const RayKindInfo& info : kRayKinds) {
    if (info.name == name) return info.kind;
  }
  std::vector<std::string_view> names;
  names.reserve(kRayKinds.size());
  for (const RayKindInfo& info : kRayKinds) names.push_back(info.name);
  throw InputError(
      fmt::format("unknown ray kind '{}'; choose from: {}", name, fmt::join(names, ", ")));
}

std::vector<RayKind> parse_ray_kinds(std::string_view list) {
  std::vector<RayKind> kinds;
  for (std::size_t start = 0; start <= list.size();) {
    const std::size_t comma = std::min(list.find(',', start), list.size());
    const RayKind kind = parse_ray_kind(list.substr(start, comma - start));
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
    start = comma + 1;
  }
  return kinds;
}

}  // namespace beambench
