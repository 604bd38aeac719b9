#include "harness/render/diagnostics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/render/picture/image_file.hpp"
#include "harness/render/picture/legend.hpp"
#include "harness/render/picture/point_marks.hpp"
#include "harness/render/shading.hpp"
#include "harness/verify/verify_ray.hpp"
#include "scenes/base/error.hpp"

namespace beambench::render {
namespace {

/// The classes in order of increasing severity; the index is the category in the map, except for
/// agreement.
constexpr std::array kBySeverity{verify::DiffClass::kTie, verify::DiffClass::kGraze,
                                 verify::DiffClass::kOracleError,
                                 verify::DiffClass::kStructureError};

std::uint8_t category_of(verify::DiffClass diff_class) {
  const auto found = std::find(kBySeverity.begin(), kBySeverity.end(), diff_class);
  return found == kBySeverity.end() ? CategoryMap::kNone
                                    : static_cast<std::uint8_t>(found - kBySeverity.begin());
}

/// Returns each pixel's worst class.
std::vector<verify::DiffClass> worst(std::span<const verify::DiffClass> classes,
                                     std::size_t samples) {
  const auto less_severe = [](verify::DiffClass a, verify::DiffClass b) {
    // kNone, the category of agreement, is the largest number; adding one makes it the smallest.
    return static_cast<std::uint8_t>(category_of(a) + 1) <
           static_cast<std::uint8_t>(category_of(b) + 1);
  };
  std::vector<verify::DiffClass> pixels;
  for (auto rest = classes; !rest.empty(); rest = rest.subspan(samples)) {
    const auto pixel = rest.first(samples);
    pixels.push_back(*std::max_element(pixel.begin(), pixel.end(), less_severe));
  }
  return pixels;
}

CategoryMap map_of(const std::vector<verify::DiffClass>& pixels, const ComparedNames& comparison) {
  CategoryMap map{fmt::format("{} against {}", comparison.verified, comparison.reference),
                  {{"tie", okabe_ito::kSkyBlue},
                   {"graze", okabe_ito::kYellow},
                   {comparison.reference + " is wrong", okabe_ito::kBluishGreen},
                   {comparison.verified + " is wrong", okabe_ito::kVermillion}},
                  {}};
  for (const verify::DiffClass diff_class : pixels) map.pixels.push_back(category_of(diff_class));
  return map;
}

using Names = std::set<std::string, std::less<>>;

/// Reads one counter. A family's own counter may be missing for a ray without such work.
std::uint64_t read(const accel::WorkCounters& counters, const std::string& name, Names& seen) {
  const auto standard = std::find(accel::kCounterNames.begin(), accel::kCounterNames.end(), name);
  if (standard != accel::kCounterNames.end()) {
    return counters.get(static_cast<accel::Counter>(standard - accel::kCounterNames.begin()));
  }
  std::uint64_t value = 0;
  for (const auto& [each, count] : counters.by_name()) {
    seen.insert(each);
    if (each == name) value = count;
  }
  return value;
}

void require_known(const std::string& counter, const Names& seen) {
  // If no names were read, the counter is a standard one.
  if (seen.empty() || seen.contains(counter)) return;
  throw InputError(fmt::format("this structure has no counter '{}'; choose from: {}", counter,
                               fmt::join(seen, ", ")));
}

}  // namespace

void write_difference(const std::filesystem::path& file, const verify::ReferenceHits& reference,
                      std::span<const verify::DiffClass> classes, const ComparedNames& comparison) {
  const std::vector<verify::DiffClass> pixels =
      worst(classes, static_cast<std::size_t>(reference.input().image()->samples()));
  const Image ground =
      shade(reference.scene(), *reference.input().image(), reference.rounded(), Shading::kPreview);
  if (image_format(file) == ImageFormat::kPng) {
    write_image(file, draw_category_map(map_of(pixels, comparison), ground));
    return;
  }
  std::vector<std::uint32_t> numbers;
  numbers.reserve(pixels.size());
  for (const verify::DiffClass each : pixels) numbers.push_back(static_cast<std::uint32_t>(each));
  const DataChannel channel{"class", std::move(numbers)};
  write_image(file, ground, {&channel, 1});
}

void DisputedPlaces::add(const verify::Mismatch& mismatch) {
  auto& points = points_[static_cast<std::size_t>(mismatch.diff_class)];
  if (points.size() == kMaxPoints) return;
  double t = 0.0;  // an any-hit query claims an occluder where there is none: use the ray's start
  if (mismatch.oracle) {
    t = mismatch.oracle->t;
  } else if (mismatch.answer && std::isfinite(mismatch.answer->t)) {
    t = mismatch.answer->t;
  }
  points.push_back(glm::dvec3(mismatch.ray.origin) + t * glm::dvec3(mismatch.ray.direction));
}

bool DisputedPlaces::empty() const {
  return std::ranges::all_of(points_, [](const auto& points) { return points.empty(); });
}

void write_disputed_places(const std::filesystem::path& file, const scenes::Scene& scene,
                           const accel::PrimaryRays& rays, const DisputedPlaces& places) {
  const verify::ReferenceHits reference(scene, rays);
  Image picture = shade(scene, rays, reference.rounded(), Shading::kPreview);
  std::vector<PointGroup> groups;
  const auto add = [&](const char* name, const glm::vec3& color, verify::DiffClass diff_class) {
    if (!places.of(diff_class).empty()) groups.push_back({{name, color}, places.of(diff_class)});
  };
  add("tie", okabe_ito::kSkyBlue, verify::DiffClass::kTie);
  add("graze", okabe_ito::kYellow, verify::DiffClass::kGraze);
  add("the oracle is wrong", okabe_ito::kBluishGreen, verify::DiffClass::kOracleError);
  add("wrong", okabe_ito::kVermillion, verify::DiffClass::kStructureError);
  const std::vector<LegendEntry> legend = mark_points(picture, rays, groups);
  write_image(file, with_legend(picture, "hits by class", legend));
}

verify::ReferenceHits reference_from(const scenes::Scene& scene, const rays::TraceInput& input,
                                     const rays::TraceResults& results) {
  std::vector<std::optional<accel::oracle::ExactHit>> hits(input.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const verify::Mismatch asked = verify::candidate_mismatch(input, results, i, std::nullopt);
    if (asked.answer && !verify::is_invalid(scene, asked.ray, *asked.answer)) {
      hits[i] = accel::oracle::ExactHit{asked.answer->t, asked.answer->primitive};
    }
  }
  return {scene, input, std::move(hits)};
}

HeatMap count_work(const accel::Accelerator& accelerator, const accel::PrimaryRays& rays,
                   const std::string& counter, accel::HitBuffer& hits, base::Progress& progress) {
  HeatMap map{counter + " per ray", rays.width(), rays.height(), {}};
  Names seen;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      std::uint64_t sum = 0;
      for (int sample = 0; sample < rays.samples(); ++sample) {
        accel::WorkCounters counters;
        const auto hit = accelerator.closest_hit(rays.ray(x, y, sample), &counters);
        hits.set(hits.index(x, y, sample), hit);
        sum += read(counters, counter, seen);
      }
      map.values.push_back(static_cast<float>(sum) / static_cast<float>(rays.samples()));
    }
    progress.advance(static_cast<double>(y + 1) / rays.height());
  }
  require_known(counter, seen);
  return map;
}

}  // namespace beambench::render
