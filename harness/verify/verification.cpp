#include "harness/verify/verification.hpp"

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "harness/rays/fingerprint.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/describe.hpp"
#include "scenes/base/error.hpp"

namespace beambench::verify {
namespace {

/// The hits that further bit-exact structures must repeat.
struct BitsReference {
  std::string label;
  rays::TraceResults results;
};

std::string answer_at(const rays::TraceResults& results, std::size_t i) {
  if (std::holds_alternative<rays::AnyHits>(results))
    return rays::is_hit_at(results, i) ? "a hit" : "no hit";
  const auto hit = std::get<accel::HitBuffer>(results).get(i);
  return hit ? fmt::format("primitive {} at t = {}", hit->primitive, hit->t) : "a miss";
}

bool same_bits(const std::optional<accel::Hit>& a, const std::optional<accel::Hit>& b) {
  if (a.has_value() != b.has_value()) return false;
  return !a || (a->primitive == b->primitive &&
                std::bit_cast<std::uint32_t>(a->t) == std::bit_cast<std::uint32_t>(b->t));
}

bool same_bits(const rays::TraceResults& a, const rays::TraceResults& b, std::size_t i) {
  if (std::holds_alternative<rays::AnyHits>(a))
    return rays::is_hit_at(a, i) == rays::is_hit_at(b, i);
  return same_bits(std::get<accel::HitBuffer>(a).get(i), std::get<accel::HitBuffer>(b).get(i));
}

void compare_bits(const rays::TraceInput& input, const rays::TraceResults& results,
                  const BitsReference& reference, const ReplayCommand& replay,
                  std::span<DiffClass> classes, VerifiedCell& cell) {
  cell.bits_reference = reference.label;
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (same_bits(results, reference.results, i)) continue;
    classes[i] = DiffClass::kStructureError;
    if (cell.different_bits++ > 0) continue;
    cell.disputes.push_back(fmt::format(
        "{}: {} found {}, {} found {}; a bit-exact structure must find the same\n  replay {}\n",
        rays::place_text(input, i), cell.label, answer_at(results, i), reference.label,
        answer_at(reference.results, i), replay.of(i)));
  }
  if (cell.different_bits > 0) cell.verdict = Verdict::kMismatch;
}

/// Describes disputes. Ties are not disputes; grazes are disputes only if there are too many.
std::vector<std::string> describe_disputes(const VerifiedView& view, const DiffReport& report,
                                           const ReplayCommand& replay) {
  std::vector<std::string> texts;
  for (const Mismatch& example : report.examples) {
    if (example.diff_class == DiffClass::kTie) continue;
    const bool grazes = example.diff_class == DiffClass::kGraze && !example.leaked;
    if (grazes && report.verdict != Verdict::kGrazes) continue;
    texts.push_back(describe(view.scene, view.input, example, replay));
  }
  return texts;
}

void fail(VerifiedCell& cell, const std::exception& error) {
  cell.verdict = Verdict::kError;
  cell.message = error.what();
}

VerifiedCell empty_cell(const scenes::Scene& scene, const std::string& rays,
                        const accel::StructureChoice& choice) {
  VerifiedCell cell;
  cell.scene = scene.name;
  cell.rays = rays;
  cell.primitives = scene.primitives.size();
  cell.structure = choice.info().name;
  cell.parameters = choice.parameters().canonical();
  cell.label = choice.short_label();
  return cell;
}

}  // namespace

std::vector<VerifiedCell> verify_each(const scenes::Scene& scene, const std::string& rays,
                                      std::vector<accel::StructureChoice> contenders,
                                      base::Progress& progress, const VerifyInto& verify_into) {
  std::stable_partition(
      contenders.begin(), contenders.end(),
      [](const accel::StructureChoice& choice) { return choice.info().name == "exhaustive"; });
  std::vector<VerifiedCell> cells;
  cells.reserve(contenders.size());
  for (const accel::StructureChoice& choice : contenders) {
    VerifiedCell& cell = cells.emplace_back(empty_cell(scene, rays, choice));
    progress.start(fmt::format("{} over {}, {} rays", cell.label, cell.scene, cell.rays));
    try {
      verify_into(choice, cell);
    } catch (const accel::UnsupportedError& error) {
      cell.verdict = Verdict::kUnsupported;
      cell.message = error.what();
    } catch (const InputError& error) {  // a cap was exceeded: this cell fails, the others continue
      fail(cell, error);
    } catch (const PluginError& error) {
      fail(cell, error);
    } catch (const rays::InvalidHit& error) {  // tracing cannot continue from there
      fail(cell, error);
    }
    const std::string_view verdict = to_string(cell.verdict);
    progress.finish(cell.message.empty() ? std::string(verdict)
                                         : fmt::format("{}: {}", verdict, cell.message));
  }
  return cells;
}

std::vector<VerifiedCell> verify_scene(const VerifiedView& view,
                                       std::vector<accel::StructureChoice> contenders,
                                       base::Progress& progress,
                                       const DrawDifferences& draw_differences) {
  const ReferenceHits reference(view.scene, view.input);
  if (const auto warning = rays::share_warning(view.input, reference.hit_count())) {
    progress.say(fmt::format("warning: {}: {}", view.scene.name, *warning));
  }
  std::optional<BitsReference> bits;
  const std::string hash = rays::hex_digits(rays::fingerprint(view.input));
  const auto verify_into = [&](const accel::StructureChoice& choice, VerifiedCell& cell) {
    rays::require_support(choice, view.input);
    const auto accelerator =
        choice.build(view.scene, rays::workload_of(view.image, view.input, view.threads));
    rays::TraceResults results = rays::make_results(view.input);
    rays::trace_with_progress(*accelerator, view.input, results, view.threads, progress);
    const ReplayCommand replay(view.program, view.scene, view.image, choice, view.input,
                               view.frame);
    cell.rays_hash = hash;
    std::vector<DiffClass> classes(view.input.size());
    cell.report = verify_results(reference, results, choice.info().conformance, classes);
    cell.verdict = cell.report->verdict;
    cell.disputes = describe_disputes(view, *cell.report, replay);
    const bool bit_exact = choice.info().conformance == accel::Conformance::kBitExact;
    if (bit_exact && bits) {
      compare_bits(view.input, results, *bits, replay, classes, cell);
    } else if (bit_exact) {
      bits = BitsReference{cell.label, std::move(results)};
    }
    if (draw_differences && !cell.passed() && view.input.image() != nullptr) {
      cell.picture = draw_differences(reference, classes, cell);
    }
  };
  return verify_each(view.scene, view.input.label(), std::move(contenders), progress, verify_into);
}

std::vector<VerifiedCell> cells_without_rays(const scenes::Scene& scene, const std::string& rays,
                                             std::vector<accel::StructureChoice> contenders,
                                             base::Progress& progress, const std::string& why) {
  return verify_each(scene, rays, std::move(contenders), progress,
                     [&](const accel::StructureChoice&, VerifiedCell& cell) {
                       cell.verdict = Verdict::kNoRays;
                       cell.message = why;
                     });
}

nlohmann::ordered_json to_json(const VerifiedCell& cell) {
  nlohmann::ordered_json out{{"scene", cell.scene},           {"ray_kind", cell.rays},
                             {"primitives", cell.primitives}, {"structure", cell.structure},
                             {"parameters", cell.parameters}, {"verdict", to_string(cell.verdict)}};
  if (!cell.rays_hash.empty()) out["rays_hash"] = cell.rays_hash;
  if (!cell.message.empty()) out["message"] = cell.message;
  if (cell.report) {
    out["rays"] = cell.report->rays;
    out["hits"] = cell.report->hits;
    for (std::size_t i = 0; i < kRecordedClassNames.size(); ++i) {
      out[std::string(kRecordedClassNames[i])] = cell.report->counts[i];
    }
  }
  if (cell.report && cell.report->leaks > 0) out["leaks"] = cell.report->leaks;
  if (!cell.bits_reference.empty()) {
    out["bits"] = {{"compared_with", cell.bits_reference}, {"different", cell.different_bits}};
  }
  if (!cell.picture.empty()) out["picture"] = cell.picture;
  out["disputes"] = cell.disputes;
  return out;
}

}  // namespace beambench::verify
