#include "harness/rays/ray_kind.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/rays/lights.hpp"
#include "scenes/base/comma_list.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::rays {
namespace {

ParameterInfo seed_parameter() {
  return integer_parameter("seed", 1, 0, std::int64_t{1} << 53, "seed of the random numbers");
}

ParameterInfo order_parameter() {
  return choice_parameter("order", std::string(kListOrder),
                          {std::string(kListOrder), std::string(kSortedOrder)},
                          "as generated, or sorted beforehand (not timed) by direction and origin, "
                          "without the marks of pencils");
}

std::vector<ParameterInfo> whitted_parameters() {
  return {integer_parameter("depth", 5, 1, 64, "maximum ray depth, including the primary ray"),
          real_parameter("least_weight", 0.0, 0.0, 1.0,
                         "rays that contribute less to their pixel are not traced"),
          choice_parameter("shadows", "rays", {"rays", "cache", "light-buffer"},
                           "how the visibility of lights is determined"),
          integer_parameter("batch", kPictureBatch, 64, kMaxPictureBatch,
                            "maximum number of rays of the same depth that are shaded together, "
                            "and whose secondary rays are traced together")};
}

std::vector<ParameterInfo> area_parameters() {
  const LightExtent extent;
  return {integer_parameter("samples", extent.points, 1, kMaxLightPoints, "points of each light"),
          real_parameter("size", extent.size, 0.0, 1e6,
                         "diameter of lights, in diagonals of the scene's box"),
          order_parameter()};
}

std::vector<ParameterInfo> occlusion_parameters() {
  return {integer_parameter("samples", 16, 1, 1024, "rays from each primary hit"),
          real_parameter("distance", 0.1, 1e-6, 1e6,
                         "length of the rays, in diagonals of the scene's box"),
          seed_parameter(), order_parameter()};
}

const std::vector<RayKindInfo>& all_kinds() {
  static const std::vector<RayKindInfo> kinds{
      {RayKind::kPrimary,
       "primary",
       "from the camera through every sample of every pixel",
       Query::kClosestHit,
       {}},
      {RayKind::kShadow,
       "shadow",
       "from the hits of primary rays to each light that the surface faces, light by light; any "
       "hit",
       Query::kAnyHit,
       {order_parameter()}},
      {RayKind::kArea, "area",
       "soft shadows: like 'shadow', but to several points of each light, which is a ball; point "
       "by point; any hit",
       Query::kAnyHit, area_parameters()},
      {RayKind::kReflection,
       "reflection",
       "mirrored at the surface where primary rays hit, as if all surfaces were mirrors",
       Query::kClosestHit,
       {order_parameter()}},
      {RayKind::kMirror,
       "mirror",
       "mirrored where primary rays hit planar mirrors, which are flat polygons with a specular "
       "factor; mirror by mirror",
       Query::kClosestHit,
       {order_parameter()}},
      {RayKind::kDiffuse,
       "diffuse",
       "one from each primary hit, in a random direction, cosine-weighted about the normal",
       Query::kClosestHit,
       {seed_parameter(), order_parameter()}},
      {RayKind::kOcclusion, "ao",
       "ambient occlusion: several from each primary hit, in random directions like those of "
       "'diffuse', up to a distance; any hit",
       Query::kAnyHit, occlusion_parameters()},
      {RayKind::kPath,
       "path",
       "diffuse paths: 'diffuse' rays, then further rays from their hits, bounce by bounce",
       Query::kClosestHit,
       {integer_parameter("bounces", 4, 1, 64,
                          "scattered rays of a path, including the one from the primary hit"),
        seed_parameter(), order_parameter()}},
      {RayKind::kRandom,
       "random",
       "as many as the image has samples, uniform among all lines through the scene's box",
       Query::kClosestHit,
       {seed_parameter(), order_parameter()}},
      {RayKind::kWhitted, "whitted",
       "a whole picture: camera, shadow, reflected and refracted rays, which follow from the "
       "structure's own hits; 'run' and 'verify' verify every ray",
       Query::kPicture, whitted_parameters()}};
  return kinds;
}

bool has(const RayKindInfo& info, std::string_view parameter) {
  return std::ranges::find(info.parameters, parameter, &ParameterInfo::name) !=
         info.parameters.end();
}

RayChoice choose(const Spec& spec) {
  const auto kinds = ray_kinds();
  const auto info = std::ranges::find(kinds, spec.name, &RayKindInfo::name);
  if (info == kinds.end()) {
    std::vector<std::string> names;
    for (const RayKindInfo& known : kinds) names.push_back(known.name);
    throw InputError(
        fmt::format("unknown ray kind '{}'; choose from: {}, or a file of saved rays (*{}, *{})",
                    excerpt(spec.name), fmt::join(names, ", "), kRayFileEnding, kCsvEnding));
  }
  const Parameters parameters(info->name, info->parameters, spec.parameters);
  RayChoice choice{info->kind, 0, false, {}, parameters.short_label()};
  if (has(*info, "seed")) choice.seed = static_cast<std::uint64_t>(parameters.integer("seed"));
  if (has(*info, "order")) choice.is_sorted = parameters.choice("order") == kSortedOrder;
  return choice;
}

/// Returns whether a list continues with another parameter, `name=value`, of the previous choice.
bool is_parameter(std::string_view rest) {
  const std::size_t end = rest.find_first_of(",:=");
  return end != std::string_view::npos && rest[end] == '=';
}

RayChoice choose_file(std::string_view path) {
  RayChoice choice;
  choice.file = path;
  choice.label = name_of_path(path);
  return choice;
}

}  // namespace

std::string_view to_string(Query query) {
  constexpr std::array<std::string_view, 3> kNames{"closest", "any", "picture"};
  return kNames[static_cast<std::size_t>(query)];
}

std::span<const RayKindInfo> ray_kinds() { return all_kinds(); }

const RayKindInfo& info_of(RayKind kind) { return all_kinds()[static_cast<std::size_t>(kind)]; }

std::string_view to_string(RayKind kind) { return info_of(kind).name; }

RayChoice parse_ray_choice(std::string_view text) {
  return is_ray_file(text) ? choose_file(text) : choose(parse_spec(text));
}

OrderedLabel divide_label(const std::string& label) {
  const std::string sorted = fmt::format("order={}", kSortedOrder);
  const std::size_t begin = is_ray_file(label) ? std::string::npos : label.find(sorted);
  if (begin == std::string::npos) return {label, kListOrder};
  std::string rays = label;
  const bool is_followed = rays.size() > begin + sorted.size();  // by another parameter
  rays.erase(is_followed ? begin : begin - 1, sorted.size() + 1);
  return {rays, kSortedOrder};
}

Parameters parameters_of(const RayChoice& choice) {
  const RayKindInfo& info = info_of(choice.kind);
  if (!choice.file.empty()) return {info.name, info.parameters, {}};
  return {info.name, info.parameters, parse_spec(choice.label).parameters};
}

std::vector<RayChoice> parse_ray_choices(std::string_view text) {
  const std::string list = without_blanks_at_commas(text);
  std::vector<RayChoice> choices;
  for (std::size_t start = 0; start <= list.size();) {
    std::size_t comma = std::min(list.find(',', start), list.size());
    while (comma < list.size() && is_parameter(std::string_view(list).substr(comma + 1))) {
      comma = std::min(list.find(',', comma + 1), list.size());
    }
    RayChoice choice = parse_ray_choice(std::string_view(list).substr(start, comma - start));
    if (std::ranges::find(choices, choice) == choices.end()) choices.push_back(std::move(choice));
    start = comma + 1;
  }
  return choices;
}

}  // namespace beambench::rays
