#include "harness/cli/difference_picture.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "harness/differ/classify.hpp"
#include "harness/differ/judge_ray.hpp"
#include "harness/picture/category_legend.hpp"
#include "harness/picture/category_map.hpp"
#include "harness/picture/image_file.hpp"
#include "harness/shade/shading.hpp"

namespace beambench {
namespace {

/// From the least grave to the gravest; the position is the category in the map, agreement aside.
constexpr std::array kByGravity{DiffClass::kTie, DiffClass::kGraze, DiffClass::kEmbreeError,
                                DiffClass::kEngineError};

std::uint8_t category_of(DiffClass diff_class) {
  const auto found = std::find(kByGravity.begin(), kByGravity.end(), diff_class);
  return found == kByGravity.end() ? CategoryMap::kNone
                                   : static_cast<std::uint8_t>(found - kByGravity.begin());
}

/// Each pixel's gravest class.
std::vector<DiffClass> gravest(std::span<const DiffClass> classes, std::size_t samples) {
  const auto less_grave = [](DiffClass a, DiffClass b) {
    // kNone, the category of agreement, is the largest number: plus one it is the smallest.
    return static_cast<std::uint8_t>(category_of(a) + 1) <
           static_cast<std::uint8_t>(category_of(b) + 1);
  };
  std::vector<DiffClass> pixels;
  for (auto rest = classes; !rest.empty(); rest = rest.subspan(samples)) {
    const auto pixel = rest.first(samples);
    pixels.push_back(*std::max_element(pixel.begin(), pixel.end(), less_grave));
  }
  return pixels;
}

CategoryMap map_of(const std::vector<DiffClass>& pixels, const ComparedNames& comparison) {
  CategoryMap map{fmt::format("{} against {}", comparison.judged, comparison.reference),
                  {{"tie", okabe_ito::kSkyBlue},
                   {"graze", okabe_ito::kYellow},
                   {comparison.reference + " is wrong", okabe_ito::kBluishGreen},
                   {comparison.judged + " is wrong", okabe_ito::kVermillion}},
                  {}};
  for (const DiffClass diff_class : pixels) map.pixels.push_back(category_of(diff_class));
  return map;
}

Image preview_of(const ReferenceHits& reference) {
  const PrimaryRays& rays = *reference.question().image();
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<ExactHit>& hit = reference.hits()[i];
    if (hit) hits.set(i, Hit{static_cast<float>(hit->t), hit->primitive});
  }
  return shade(reference.scene(), rays, hits, Shading::kPreview);
}

}  // namespace

void write_difference(const std::filesystem::path& file, const ReferenceHits& reference,
                      std::span<const DiffClass> classes, const ComparedNames& comparison) {
  const std::vector<DiffClass> pixels =
      gravest(classes, static_cast<std::size_t>(reference.question().image()->samples()));
  const Image ground = preview_of(reference);
  if (image_format(file) == ImageFormat::kPng) {
    write_image(file, draw_category_map(map_of(pixels, comparison), ground));
    return;
  }
  std::vector<std::uint32_t> numbers;
  numbers.reserve(pixels.size());
  for (const DiffClass each : pixels) numbers.push_back(static_cast<std::uint32_t>(each));
  const DataChannel channel{"class", std::move(numbers)};
  write_image(file, ground, {&channel, 1});
}

ReferenceHits reference_from(const Scene& scene, const Question& question, const Answers& answers) {
  std::vector<std::optional<ExactHit>> hits(question.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Mismatch asked = ask_again(question, answers, i, std::nullopt);
    if (asked.engine && !is_nonsense(scene, asked.ray, *asked.engine)) {
      hits[i] = ExactHit{asked.engine->t, asked.engine->primitive};
    }
  }
  return {scene, question, std::move(hits)};
}

}  // namespace beambench
