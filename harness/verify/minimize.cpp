#include "harness/verify/minimize.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <ostream>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "harness/rays/ray_file.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/claim_verifier.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/exact_search.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/formats/mesh/obj_writer.hpp"
#include "scenes/formats/nff/nff_writer.hpp"
#include "scenes/subset.hpp"

namespace beambench::verify {
namespace {

constexpr std::size_t kMaxRuns = 2000;

rays::TraceInput list_of(std::vector<accel::Ray> rays, const rays::TraceInput& like) {
  rays::RaySet set;
  set.rays = std::move(rays);
  set.label = like.label();
  set.query = like.query();
  if (const rays::RaySet* list = like.list()) {
    set.may_graze = list->may_graze;
    set.must_hit = list->must_hit;
  }
  return rays::TraceInput(std::move(set));
}

std::vector<accel::Ray> rays_of(const rays::TraceInput& input) {
  if (input.list() != nullptr) return input.list()->rays;
  std::vector<accel::Ray> rays(input.size());
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = input.ray(i);
  return rays;
}

/// Looks for wrong results over parts of a scene and of an input.
class Trial {
 public:
  Trial(const scenes::Scene& scene, const Mismatch& like, const FindWrong& find_wrong,
        base::Progress& progress)
      : scene_(scene), like_(like), find_wrong_(find_wrong), progress_(progress) {}

  /// Returns a result over these primitives with the fault; nothing if no result has it, or after
  /// too many runs.
  std::optional<Mismatch> wrong(std::span<const scenes::PrimitiveId> ids,
                                const rays::TraceInput& input) {
    if (runs_ == kMaxRuns) return std::nullopt;
    ++runs_;
    progress_.advance(static_cast<double>(runs_) / kMaxRuns);
    return find_wrong_(scenes::subset(scene_, ids), input, &like_);
  }
  std::size_t runs() const { return runs_; }

 private:
  const scenes::Scene& scene_;
  const Mismatch& like_;
  const FindWrong& find_wrong_;
  base::Progress& progress_;
  std::size_t runs_ = 0;
};

/// Removes smaller and smaller parts of a list while `fails` is true for the remaining list.
template <class T, class Fails>
std::vector<T> reduced(std::vector<T> items, Fails fails) {
  for (std::size_t part = (items.size() + 1) / 2; part >= 1; part /= 2) {
    bool removed = true;
    while (removed) {
      removed = false;
      for (std::size_t first = 0; first < items.size();) {
        const std::size_t last = std::min(first + part, items.size());
        std::vector<T> rest(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(first));
        rest.insert(rest.end(), items.begin() + static_cast<std::ptrdiff_t>(last), items.end());
        if (!rest.empty() && fails(rest)) {
          items = std::move(rest);
          removed = true;
        } else {
          first = last;
        }
      }
      if (part > 1) break;  // single elements are tried until none can be left out
    }
  }
  return items;
}

/// Returns the primitives of the results, ascending; for a leak, all primitives that may meet where
/// the ray passes.
std::vector<scenes::PrimitiveId> named(const scenes::Scene& scene, const Mismatch& wrong) {
  if (wrong.leaked) return primitives_near(scene, wrong.ray);
  std::vector<scenes::PrimitiveId> ids;
  const auto add = [&](const auto& hit) {
    if (hit && hit->primitive < scene.primitives.size()) ids.push_back(hit->primitive);
  };
  add(wrong.answer);
  add(wrong.oracle);
  add(wrong.exact);
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

/// Returns whether rays just beside a leak, on all sides, hit the scene. Otherwise, the ray passes
/// a rim of what is left of the closed surface, where a miss is correct.
bool is_surrounded(const scenes::Scene& scene, const Mismatch& leak) {
  if (!leak.exact) return false;
  constexpr int kSides = 8;
  const glm::dvec3 along = glm::normalize(glm::dvec3(leak.ray.direction));
  const glm::dvec3 other = std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(along, other));
  const glm::dvec3 up = glm::cross(right, along);
  const double apart = 2.0 * tolerance(scene, leak.ray, *leak.exact);
  for (int side = 0; side < kSides; ++side) {
    const double angle = 2.0 * std::numbers::pi * side / kSides;
    accel::Ray beside = leak.ray;
    beside.origin += glm::vec3(apart * (std::cos(angle) * right + std::sin(angle) * up));
    if (crossings(scene, beside, primitives_near(scene, beside)).empty()) return false;
  }
  return true;
}

}  // namespace

Tracer tracer_of(const accel::StructureChoice& structure) {
  return [structure](const scenes::Scene& scene, const rays::TraceInput& input) {
    const auto accelerator = structure.build(scene);
    rays::TraceResults results = rays::make_results(input);
    rays::poison(results);
    rays::trace(*accelerator, input, results);
    rays::HitTable table;
    if (auto* any = std::get_if<rays::AnyHits>(&results)) {
      table.occluded = std::move(*any);
    } else {
      const auto& hits = std::get<accel::HitBuffer>(results);
      table.t.assign(hits.t(), hits.t() + hits.size());
      table.primitives.assign(hits.primitive(), hits.primitive() + hits.size());
    }
    return table;
  };
}

DiffReport verify_tracer(const scenes::Scene& scene, const rays::TraceInput& input,
                         const Tracer& tracer) {
  const rays::HitTable table = tracer(scene, input);
  ClaimVerifier verifier(scene);
  if (input.list() != nullptr) verifier.judge_as(*input.list());
  verifier.add(rays_of(input), table.view());
  return verifier.finish();
}

std::optional<Mismatch> first_fault(const scenes::Scene& scene, const DiffReport& report,
                                    const Mismatch* like) {
  for (const Mismatch& found : report.examples) {
    if (!found.is_fault()) continue;
    if (like == nullptr) return found;
    if (found.leaked != like->leaked || found.reason != like->reason) continue;
    if (!found.leaked || is_surrounded(scene, found)) return found;
  }
  return std::nullopt;
}

FindWrong wrong_by_differ(Tracer tracer) {
  return [tracer = std::move(tracer)](const scenes::Scene& scene, const rays::TraceInput& input,
                                      const Mismatch* like) -> std::optional<Mismatch> {
    try {
      return first_fault(scene, verify_tracer(scene, input, tracer), like);
    } catch (const InvalidClaim& error) {
      Mismatch found{};
      found.index = error.index;
      found.ray = input.ray(error.index);
      found.query = input.query();
      found.diff_class = DiffClass::kStructureError;
      found.reason = "invalid hit: it has a number that no hit can have";
      if (like != nullptr && like->reason != found.reason) return std::nullopt;
      return found;
    } catch (const InputError&) {  // over this part it fails differently
      return std::nullopt;
    } catch (const PluginError&) {
      return std::nullopt;
    }
  };
}

std::optional<MinimalCase> minimize(const scenes::Scene& scene, const rays::TraceInput& input,
                                    const Mismatch& wrong, const FindWrong& find_wrong,
                                    base::Progress& progress) {
  progress.start(fmt::format("reducing ray {} over {}", wrong.index, scene.name));
  Trial trial(scene, wrong, find_wrong, progress);
  std::vector<scenes::PrimitiveId> all(scene.primitives.size());
  std::iota(all.begin(), all.end(), 0U);

  // Fewer primitives make all later steps quick, so the primitives named in the results are tried
  // first.
  std::vector<scenes::PrimitiveId> ids = named(scene, wrong);
  rays::TraceInput kept = list_of({wrong.ray}, input);
  std::optional<Mismatch> found = ids.empty() ? std::nullopt : trial.wrong(ids, kept);
  if (!found) {
    ids = all;
    found = trial.wrong(ids, kept);
  }
  if (!found && input.list() != nullptr) {  // one ray is not enough
    kept = list_of(reduced(input.list()->rays,
                           [&](const std::vector<accel::Ray>& rays) {
                             return trial.wrong(all, list_of(rays, input)).has_value();
                           }),
                   input);
    found = trial.wrong(ids, kept);
  }
  if (!found) {  // it needs the pencils of the list, or the image
    kept = input;
    found = trial.wrong(ids, kept);
  }
  if (!found) {
    progress.finish("without this fault when it is traced again");
    return std::nullopt;
  }
  ids = reduced(std::move(ids), [&](const std::vector<scenes::PrimitiveId>& rest) {
    const auto still = trial.wrong(rest, kept);
    if (still) found = still;
    return still.has_value();
  });
  progress.finish(fmt::format("{} primitives, {} rays", ids.size(), kept.size()));
  return MinimalCase{scenes::subset(scene, ids), std::move(ids), std::move(kept), *found,
                     trial.runs()};
}

MinimalCase named_case(const scenes::Scene& scene, const Mismatch& wrong) {
  rays::RaySet set;
  set.rays = {wrong.ray};
  set.query = wrong.query;
  set.must_hit = wrong.must_hit;
  std::vector<scenes::PrimitiveId> ids = named(scene, wrong);
  scenes::Scene part = scenes::subset(scene, ids);
  return {std::move(part), std::move(ids), rays::TraceInput(std::move(set)), wrong, 0, false};
}

void write_case(const std::filesystem::path& folder, const MinimalCase& minimal,
                const std::string& whole, const std::string& subject) {
  make_folder(folder);
  const scenes::Scene& scene = minimal.scene;
  write_file(folder / "scene.nff",
             [&](std::ostream& file) { scenes::nff::write_nff(scene, file); });
  if (scene.spheres.empty() && scene.cones.empty() && !scene.triangles.empty()) {
    write_file(folder / "scene.obj",
               [&](std::ostream& file) { scenes::mesh::write_obj(scene, file); });
  }
  nlohmann::ordered_json out{{"scene", whole},
                             {"subject", subject},
                             {"query", rays::to_string(minimal.input.query())},
                             {"primitives", minimal.primitives},
                             {"rays", minimal.input.size()},
                             {"repeated", minimal.repeated},
                             {"runs", minimal.runs}};
  if (const accel::PrimaryRays* image = minimal.input.image()) {
    out["image"] = {
        {"width", image->width()}, {"height", image->height()}, {"samples", image->samples()}};
  }
  const rays::TraceInput list = minimal.input.list() != nullptr
                                    ? minimal.input
                                    : list_of({minimal.mismatch.ray}, minimal.input);
  rays::write_ray_file(folder / "ray.rays", *list.list(), {{"scene", "scene.nff"}});
  rays::write_ray_file(folder / "ray.csv", *list.list(), {});
  out["wrong"] = to_json(minimal.mismatch);
  write_file(folder / "case.json", json_text(out) + '\n');
}

}  // namespace beambench::verify
