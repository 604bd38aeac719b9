#include "harness/cli/verification.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <span>

#include <fmt/format.h>

#include "harness/cli/difference_picture.hpp"
#include "harness/cli/watched_trace.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

/// The buffer that further bit-exact structures must repeat.
struct BitsReference {
  std::string label;
  HitBuffer hits;
};

std::string show(const std::optional<Hit>& hit) {
  return hit ? fmt::format("primitive {} at t = {}", hit->primitive, hit->t) : "a miss";
}

bool same_bits(const std::optional<Hit>& a, const std::optional<Hit>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->primitive == b->primitive &&
                std::bit_cast<std::uint32_t>(a->t) == std::bit_cast<std::uint32_t>(b->t));
}

void compare_bits(const HitBuffer& hits, const BitsReference& reference,
                  const ReplayCommand& replay, std::span<DiffClass> classes, VerifiedCell& cell) {
  cell.bits_reference = reference.label;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto ours = hits.get(i);
    const auto theirs = reference.hits.get(i);
    if (same_bits(ours, theirs)) continue;
    classes[i] = DiffClass::kEngineError;
    if (cell.different_bits++ > 0) continue;
    const auto samples = static_cast<std::size_t>(hits.samples());
    const auto width = static_cast<std::size_t>(hits.width());
    const auto x = static_cast<int>(i / samples % width);
    const auto y = static_cast<int>(i / samples / width);
    const auto sample = static_cast<int>(i % samples);
    cell.disputes.push_back(fmt::format(
        "pixel ({}, {}) sample {}: {} found {}, {} found {}; a bit-exact structure must find the "
        "same\n  replay {}\n",
        x, y, sample, cell.label, show(ours), reference.label, show(theirs),
        replay.of(x, y, sample)));
  }
  if (cell.different_bits > 0) cell.verdict = to_string(Verdict::kMismatch);
}

/// Ties are no dispute, and grazes only where there are too many of them.
std::vector<std::string> describe_disputes(const Scene& scene, const DiffReport& report,
                                           const ReplayCommand& replay) {
  std::vector<std::string> texts;
  for (const Mismatch& example : report.examples) {
    if (example.diff_class == DiffClass::kTie) continue;
    if (example.diff_class == DiffClass::kGraze && report.verdict != Verdict::kGrazes) continue;
    texts.push_back(describe(scene, example, replay));
  }
  return texts;
}

/// `tetra-n-4-default-samet-max_level-5.png`: what a file system and a shell take.
std::string picture_name(const VerifiedCell& cell, std::string_view camera) {
  std::string name = fmt::format("{}-{}-{}", cell.scene, camera, cell.label);
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.') c = '-';
  }
  return name + ".png";
}

class SceneVerifier {
 public:
  SceneVerifier(const VerifiedView& view, const std::filesystem::path& pictures, Progress& progress)
      : scene_(view.scene),
        camera_(view.camera.name),
        rays_(view.rays),
        reference_(scene_, rays_),
        pictures_(pictures),
        progress_(progress) {}

  VerifiedCell verify(const StructureChoice& choice) {
    VerifiedCell cell;
    cell.scene = scene_.name;
    cell.primitives = scene_.primitives.size();
    cell.structure = choice.info().name;
    cell.parameters = choice.parameters().canonical();
    cell.label = choice.short_label();
    progress_.start(fmt::format("{} over {}", cell.label, cell.scene));
    try {
      judge_into(choice, cell);
    } catch (const InputError& error) {  // a cap was exceeded: this cell fails, the others go on
      cell.verdict = "error";
      cell.message = error.what();
    }
    progress_.finish(cell.message.empty() ? cell.verdict
                                          : fmt::format("{}: {}", cell.verdict, cell.message));
    return cell;
  }

 private:
  void judge_into(const StructureChoice& choice, VerifiedCell& cell) {
    const auto accelerator = choice.build(scene_);
    HitBuffer hits(rays_.width(), rays_.height(), rays_.samples());
    watched_trace(*accelerator, rays_, hits, progress_);
    const ReplayCommand replay(scene_, camera_, choice, rays_);
    std::vector<DiffClass> classes(hits.size());
    cell.report = judge(reference_, hits, choice.info().conformance, classes);
    cell.verdict = to_string(cell.report->verdict);
    cell.disputes = describe_disputes(scene_, *cell.report, replay);
    if (choice.info().conformance == Conformance::kBitExact) {
      if (bits_) {
        compare_bits(hits, *bits_, replay, classes, cell);
      } else {
        bits_ = BitsReference{cell.label, std::move(hits)};
      }
    }
    if (!pictures_.empty() && !cell.passed()) {
      cell.picture = pictures_ / picture_name(cell, camera_);
      write_difference(cell.picture, reference_, classes, {cell.label, kOracleName});
    }
  }

  const Scene& scene_;
  std::string_view camera_;
  const PrimaryRays& rays_;
  ReferenceHits reference_;
  const std::filesystem::path& pictures_;
  Progress& progress_;
  std::optional<BitsReference> bits_;
};

}  // namespace

std::vector<VerifiedCell> verify_scene(const VerifiedView& view,
                                       std::vector<StructureChoice> contenders,
                                       const std::filesystem::path& pictures, Progress& progress) {
  std::stable_partition(contenders.begin(), contenders.end(), [](const StructureChoice& choice) {
    return choice.info().name == "exhaustive";
  });
  SceneVerifier verifier(view, pictures, progress);
  std::vector<VerifiedCell> cells;
  cells.reserve(contenders.size());
  for (const StructureChoice& choice : contenders) cells.push_back(verifier.verify(choice));
  return cells;
}

nlohmann::ordered_json to_json(const VerifiedCell& cell) {
  nlohmann::ordered_json out{{"scene", cell.scene},
                             {"primitives", cell.primitives},
                             {"structure", cell.structure},
                             {"parameters", cell.parameters},
                             {"verdict", cell.verdict}};
  if (!cell.message.empty()) out["message"] = cell.message;
  if (cell.report) {
    out["rays"] = cell.report->rays;
    out["hits"] = cell.report->hits;
    for (std::size_t i = 0; i < kDiffClassNames.size(); ++i) {
      out[std::string(kDiffClassNames[i])] = cell.report->counts[i];
    }
  }
  if (!cell.bits_reference.empty()) {
    out["bits"] = {{"compared_with", cell.bits_reference}, {"different", cell.different_bits}};
  }
  if (!cell.picture.empty()) out["picture"] = cell.picture.string();
  out["disputes"] = cell.disputes;
  return out;
}

}  // namespace beambench
