#include "harness/cli/verification.hpp"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "harness/cli/inputs.hpp"
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

void compare_bits(const HitBuffer& hits, const BitsReference& reference, VerifiedCell& cell) {
  cell.bits_reference = reference.label;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto ours = hits.get(i);
    const auto theirs = reference.hits.get(i);
    if (same_bits(ours, theirs)) continue;
    if (cell.different_bits++ > 0) continue;
    const std::size_t pixel = i / static_cast<std::size_t>(hits.samples());
    const auto width = static_cast<std::size_t>(hits.width());
    cell.disputes.push_back(fmt::format(
        "pixel ({}, {}): {} found {}, {} found {}; a bit-exact structure must find the same",
        pixel % width, pixel / width, cell.label, show(ours), reference.label, show(theirs)));
  }
  if (cell.different_bits > 0) cell.verdict = to_string(Verdict::kMismatch);
}

/// Ties are no dispute, and grazes only where there are too many of them.
std::vector<std::string> describe_disputes(const Scene& scene, const DiffReport& report) {
  std::vector<std::string> texts;
  for (const Mismatch& example : report.examples) {
    if (example.diff_class == DiffClass::kTie) continue;
    if (example.diff_class == DiffClass::kGraze && report.verdict != Verdict::kGrazes) continue;
    texts.push_back(describe(scene, example));
  }
  return texts;
}

class SceneVerifier {
 public:
  SceneVerifier(const Scene& scene, const PrimaryRays& rays, Progress& progress)
      : scene_(scene), rays_(rays), reference_(scene, rays), progress_(progress) {}

  VerifiedCell verify(const StructureChoice& choice) {
    VerifiedCell cell;
    cell.scene = scene_.name;
    cell.primitives = scene_.primitives.size();
    cell.structure = choice.info().name;
    cell.parameters = choice.parameters().canonical();
    cell.label = short_label(choice);
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
    cell.report = judge(reference_, hits, choice.info().conformance);
    cell.verdict = to_string(cell.report->verdict);
    cell.disputes = describe_disputes(scene_, *cell.report);
    if (choice.info().conformance != Conformance::kBitExact) return;
    if (bits_) {
      compare_bits(hits, *bits_, cell);
    } else {
      bits_ = BitsReference{cell.label, std::move(hits)};
    }
  }

  const Scene& scene_;
  const PrimaryRays& rays_;
  ReferenceHits reference_;
  Progress& progress_;
  std::optional<BitsReference> bits_;
};

}  // namespace

std::vector<VerifiedCell> verify_scene(const Scene& scene, const PrimaryRays& rays,
                                       std::vector<StructureChoice> contenders,
                                       Progress& progress) {
  std::stable_partition(contenders.begin(), contenders.end(), [](const StructureChoice& choice) {
    return choice.info().name == "exhaustive";
  });
  SceneVerifier verifier(scene, rays, progress);
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
  out["disputes"] = cell.disputes;
  return out;
}

}  // namespace beambench
