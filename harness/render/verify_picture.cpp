#include "harness/render/verify_picture.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/render/verified_picture.hpp"
#include "harness/verify/describe.hpp"
#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

class PictureVerifier {
 public:
  PictureVerifier(const scenes::Scene& scene, const rays::ImageOfRays& image,
                  const rays::RayChoice& choice)
      : scene_(scene),
        rays_(image.camera, image.resolution.width, image.resolution.height, image.samples),
        workload_(rays::workload_of(image, rays_)),
        options_(whitted_options(choice)),
        eye_(scene, rays_) {}

  void verify_into(const accel::StructureChoice& choice, verify::VerifiedCell& cell) {
    const auto structure = choice.build(scene_, workload_);
    accel::HitBuffer hits(rays_.width(), rays_.height(), rays_.samples());
    structure->trace(rays_, hits, nullptr);
    RecordedPicture picture = record_picture(scene_, *structure, rays_, std::move(hits), options_,
                                             rays::HitCheck(scene_, choice));
    if (choice.info().conformance == accel::Conformance::kBitExact)
      compare_bits(picture.image, cell);
    const auto judged =
        verify_recorded_picture(eye_, std::move(picture), choice.info().conformance);
    cell.report = sum_of(judged);
    if (cell.different_bits > 0) cell.report->verdict = verify::Verdict::kMismatch;
    cell.verdict = cell.report->verdict;
    for (const VerifiedRays& rays : judged) describe_disputes(rays, cell);
  }

 private:
  void compare_bits(const Image& image, verify::VerifiedCell& cell) {
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

  void describe_disputes(const VerifiedRays& rays, verify::VerifiedCell& cell) const {
    if (verify::is_right(rays.report.verdict)) return;
    for (const verify::Mismatch& example : rays.report.examples) {
      cell.disputes.push_back(
          fmt::format("{} rays, {}", rays.kind, verify::describe(scene_, rays.input, example)));
    }
  }

  const scenes::Scene& scene_;
  accel::PrimaryRays rays_;
  accel::Workload workload_;
  WhittedOptions options_;
  verify::ReferenceHits eye_;
  std::optional<std::pair<std::string, Image>> bits_;  ///< of the first bit-exact structure
};

}  // namespace

std::vector<verify::VerifiedCell> verify_picture(const scenes::Scene& scene,
                                                 const rays::ImageOfRays& image,
                                                 const rays::RayChoice& choice,
                                                 std::vector<accel::StructureChoice> contenders,
                                                 base::Progress& progress) {
  PictureVerifier verifier(scene, image, choice);
  return verify::verify_each(
      scene, choice.label, std::move(contenders), progress,
      [&](const accel::StructureChoice& contender, verify::VerifiedCell& cell) {
        verifier.verify_into(contender, cell);
      });
}

}  // namespace beambench::render
