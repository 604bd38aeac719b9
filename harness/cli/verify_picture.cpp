#include "harness/cli/verify_picture.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/shade/judged_picture.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

class PictureVerifier {
 public:
  PictureVerifier(const Scene& scene, const ImageOfRays& image, const RayChoice& choice)
      : scene_(scene),
        rays_(image.camera, image.resolution.width, image.resolution.height, image.samples),
        workload_(workload_of(image, rays_)),
        options_(whitted_options(choice)),
        eye_(scene, rays_) {}

  void judge_into(const StructureChoice& choice, VerifiedCell& cell) {
    const auto structure = choice.build(scene_, workload_);
    HitBuffer hits(rays_.width(), rays_.height(), rays_.samples());
    structure->trace(rays_, hits);
    RecordedPicture picture = record_picture(scene_, *structure, rays_, std::move(hits), options_,
                                             HitCheck(scene_, choice));
    if (choice.info().conformance == Conformance::kBitExact) compare_bits(picture.image, cell);
    const auto judged = judge_picture(eye_, std::move(picture), choice.info().conformance);
    cell.report = sum_of(judged);
    if (cell.different_bits > 0) cell.report->verdict = Verdict::kMismatch;
    cell.verdict = to_string(cell.report->verdict);
    for (const JudgedRays& rays : judged) describe_disputes(rays, cell);
  }

 private:
  void compare_bits(const Image& image, VerifiedCell& cell) {
    if (!bits_) {
      bits_.emplace(cell.label, image);
      return;
    }
    cell.bits_reference = bits_->first;
    for (std::size_t i = 0; i < image.pixels().size(); ++i) {
      if (image.pixels()[i] != bits_->second.pixels()[i]) ++cell.different_bits;
    }
    if (cell.different_bits == 0) return;
    cell.disputes.push_back(fmt::format(
        "{} of {} pixels differ from those of {}; a bit-exact structure must draw the same\n",
        cell.different_bits, image.pixels().size(), bits_->first));
  }

  void describe_disputes(const JudgedRays& rays, VerifiedCell& cell) const {
    if (is_right(rays.report.verdict)) return;
    for (const Mismatch& example : rays.report.examples) {
      cell.disputes.push_back(
          fmt::format("{} rays, {}", rays.kind, describe(scene_, rays.question, example)));
    }
  }

  const Scene& scene_;
  PrimaryRays rays_;
  Workload workload_;
  WhittedOptions options_;
  ReferenceHits eye_;
  std::optional<std::pair<std::string, Image>> bits_;  ///< of the first bit-exact structure
};

}  // namespace

std::vector<VerifiedCell> verify_picture(const Scene& scene, const ImageOfRays& image,
                                         const RayChoice& choice,
                                         std::vector<StructureChoice> contenders,
                                         Progress& progress) {
  PictureVerifier verifier(scene, image, choice);
  return verify_each(scene, choice.label, std::move(contenders), progress,
                     [&](const StructureChoice& contender, VerifiedCell& cell) {
                       verifier.judge_into(contender, cell);
                     });
}

}  // namespace beambench
