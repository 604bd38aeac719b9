#include "harness/cli/difference_picture.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "harness/render/picture/category_map.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading.hpp"
#include "harness/verify/verify_ray.hpp"

namespace beambench::cli {
namespace {

/// From the least grave to the gravest; the position is the category in the map, agreement aside.
constexpr std::array kByGravity{verify::DiffClass::kTie, verify::DiffClass::kGraze,
                                verify::DiffClass::kEmbreeError,
                                verify::DiffClass::kStructureError};

std::uint8_t category_of(verify::DiffClass diff_class) {
  const auto found = std::find(kByGravity.begin(), kByGravity.end(), diff_class);
  return found == kByGravity.end() ? render::CategoryMap::kNone
                                   : static_cast<std::uint8_t>(found - kByGravity.begin());
}

/// Each pixel's gravest class.
std::vector<verify::DiffClass> gravest(std::span<const verify::DiffClass> classes,
                                       std::size_t samples) {
  const auto less_grave = [](verify::DiffClass a, verify::DiffClass b) {
    // kNone, the category of agreement, is the largest number: plus one it is the smallest.
    return static_cast<std::uint8_t>(category_of(a) + 1) <
           static_cast<std::uint8_t>(category_of(b) + 1);
  };
  std::vector<verify::DiffClass> pixels;
  for (auto rest = classes; !rest.empty(); rest = rest.subspan(samples)) {
    const auto pixel = rest.first(samples);
    pixels.push_back(*std::max_element(pixel.begin(), pixel.end(), less_grave));
  }
  return pixels;
}

render::CategoryMap map_of(const std::vector<verify::DiffClass>& pixels,
                           const ComparedNames& comparison) {
  render::CategoryMap map{fmt::format("{} against {}", comparison.judged, comparison.reference),
                          {{"tie", render::okabe_ito::kSkyBlue},
                           {"graze", render::okabe_ito::kYellow},
                           {comparison.reference + " is wrong", render::okabe_ito::kBluishGreen},
                           {comparison.judged + " is wrong", render::okabe_ito::kVermillion}},
                          {}};
  for (const verify::DiffClass diff_class : pixels) map.pixels.push_back(category_of(diff_class));
  return map;
}

render::Image preview_of(const verify::ReferenceHits& reference) {
  const accel::PrimaryRays& rays = *reference.input().image();
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<accel::embree::ExactHit>& hit = reference.hits()[i];
    if (hit) hits.set(i, accel::Hit{static_cast<float>(hit->t), hit->primitive});
  }
  return render::shade(reference.scene(), rays, hits, render::Shading::kPreview);
}

}  // namespace

void write_difference(const std::filesystem::path& file, const verify::ReferenceHits& reference,
                      std::span<const verify::DiffClass> classes, const ComparedNames& comparison) {
  const std::vector<verify::DiffClass> pixels =
      gravest(classes, static_cast<std::size_t>(reference.input().image()->samples()));
  const render::Image ground = preview_of(reference);
  if (render::image_format(file) == render::ImageFormat::kPng) {
    render::write_image(file, render::draw_category_map(map_of(pixels, comparison), ground));
    return;
  }
  std::vector<std::uint32_t> numbers;
  numbers.reserve(pixels.size());
  for (const verify::DiffClass each : pixels) numbers.push_back(static_cast<std::uint32_t>(each));
  const render::DataChannel channel{"class", std::move(numbers)};
  render::write_image(file, ground, {&channel, 1});
}

verify::ReferenceHits reference_from(const scenes::Scene& scene, const rays::TraceInput& input,
                                     const rays::TraceResults& results) {
  std::vector<std::optional<accel::embree::ExactHit>> hits(input.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const verify::Mismatch asked = verify::candidate_mismatch(input, results, i, std::nullopt);
    if (asked.answer && !verify::is_invalid(scene, asked.ray, *asked.answer)) {
      hits[i] = accel::embree::ExactHit{asked.answer->t, asked.answer->primitive};
    }
  }
  return {scene, input, std::move(hits)};
}

}  // namespace beambench::cli
