#include "harness/verify/claim_verifier.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "accel/oracle/oracle.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/differ.hpp"
#include "harness/verify/tolerance.hpp"
#include "harness/verify/verify_ray.hpp"

namespace beambench::verify {
namespace {

constexpr std::size_t kReferencesAtOnce = std::size_t{1}
                                          << 16U;  // rays whose reference is in memory at once
// As in the differ's exact search: after this many faults or tests, further disputes are presumed
// to be faults.
constexpr std::uint64_t kEnoughFaults = 64;
constexpr std::uint64_t kPrimitiveBudget = 400'000'000;  // primitives

constexpr std::string_view kBesideRay = "the point does not lie on the ray";
constexpr std::string_view kOutsideInterval = "t is outside of the ray's interval";
constexpr std::string_view kNowhere = "there is no surface at this place";
constexpr std::string_view kNotSearched =
    "the oracle hits another place, and no surface was searched for here because enough faults or "
    "tests had already been counted";

/// Returns the ids of a claim, of primitives or triangles; empty if unknown.
std::span<const std::uint32_t> ids_of(const rays::ClaimedHits& hits) {
  return hits.primitives.empty() ? hits.triangles : hits.primitives;
}

/// Throws InvalidClaim for an invalid claim.
void require_valid_claim(const scenes::Scene& scene, const rays::ClaimedHits& hits, std::size_t i,
                         std::size_t index) {
  const auto refuse = [&](const std::string& fault) { throw InvalidClaim(index, fault); };
  if (!hits.occluded.empty()) {
    if (hits.occluded[i] > 1) refuse(fmt::format("{} is neither 0 nor 1", hits.occluded[i]));
    return;
  }
  bool nowhere = false;
  if (!hits.t.empty()) {
    const float t = hits.t[i];
    if (std::isnan(t)) refuse("t is not a number; a miss has t = infinity");
    if (t == -accel::kInfinity) refuse("t is -infinity; a miss has t = infinity");
    nowhere = t == accel::kInfinity;
  } else {
    const glm::vec3& point = hits.points[i];
    const auto count = [&](auto is) { return is(point.x) + is(point.y) + is(point.z); };
    if (count([](float x) { return std::isnan(x) ? 1 : 0; }) > 0) {
      refuse("a coordinate of the point is not a number; a miss has infinite ones");
    }
    const int infinite = count([](float x) { return std::isinf(x) ? 1 : 0; });
    if (infinite != 0 && infinite != 3) refuse("some coordinates of the point are infinite");
    nowhere = infinite == 3;
  }
  const auto ids = ids_of(hits);
  if (ids.empty() || ids[i] == scenes::kNoPrimitive) return;
  const bool triangles = hits.primitives.empty();
  std::size_t known = scene.primitives.size();
  std::size_t others = scene.triangles.size();
  std::string_view what = "primitive";
  std::string_view other = "triangle";
  if (triangles) {
    std::swap(known, others);
    std::swap(what, other);
  }
  if (ids[i] >= known) {
    // Polygons of several triangles, or spheres and cones, make the two kinds of ids differ.
    refuse(fmt::format("there is no {} {}: {}{}", what, ids[i],
                       known == 0 ? std::string("the scene has none")
                                  : fmt::format("the scene's are 0 to {}", known - 1),
                       ids[i] < others ? fmt::format("; if the ids are those of {0}s, give them as "
                                                     "'{0}' instead of '{1}'",
                                                     other, what)
                                       : ""));
  }
  if (nowhere) refuse(fmt::format("{} {} is named, but its place is infinite", what, ids[i]));
}

/// A claim in the form of a structure's hit, or the reason why it is wrong.
struct Answer {
  accel::Hit hit{accel::kInfinity, scenes::kNoPrimitive};
  bool primitive_known = true;
  std::string_view fault{};
};

/// Moves a t near an end of the interval into it, because t was computed from the point by our own
/// division.
float within(const accel::Ray& ray, double t, double length, double near) {
  if (t < ray.t_min && (ray.t_min - t) * length <= near) return ray.t_min;
  if (t > ray.t_max && (t - ray.t_max) * length <= near) return ray.t_max;
  return static_cast<float>(t);
}

Answer answer_of(const scenes::Scene& scene, const accel::Ray& ray, const rays::ClaimedHits& hits,
                 std::size_t i) {
  const auto ids = ids_of(hits);
  if (!ids.empty() && ids[i] == scenes::kNoPrimitive) return {};
  Answer answer;
  answer.primitive_known = !ids.empty();
  if (!hits.primitives.empty()) answer.hit.primitive = ids[i];
  if (!hits.triangles.empty()) answer.hit.primitive = scene.triangles[ids[i]].primitive;
  if (!hits.t.empty()) {
    answer.hit.t = hits.t[i];
    if (answer.hit.t == accel::kInfinity) return {};
  } else {
    if (std::isinf(hits.points[i].x)) return {};
    const glm::dvec3 direction(ray.direction);
    const glm::dvec3 offset = glm::dvec3(hits.points[i]) - glm::dvec3(ray.origin);
    const double length = glm::length(direction);
    const double t = glm::dot(offset, direction) / (length * length);
    const double near = tolerance(ray, glm::dvec3(hits.points[i]));
    answer.hit.t = within(ray, t, length, near);
    if (!(glm::length(offset - t * direction) <= near)) answer.fault = kBesideRay;
  }
  if (!answer.primitive_known && !accel::in_interval(ray, answer.hit.t)) {
    answer.fault = kOutsideInterval;
  }
  return answer;
}

}  // namespace

struct ClaimVerifier::State {
  State(const scenes::Scene& s, OnMismatch on_mismatch)
      : scene(s), differ(accel::Conformance::kTolerance, std::move(on_mismatch)) {}

  void require_valid_part(std::span<const accel::Ray> rays, const rays::ClaimedHits& hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      try {
        accel::require_valid(rays[i]);
      } catch (const InputError& error) {
        throw InvalidClaim(verified + i, error.what());
      }
      require_valid_claim(scene, hits, i, verified + i);
    }
  }

  void add_block(std::span<const accel::Ray> block, const rays::ClaimedHits& hits,
                 std::span<DiffClass> classes) {
    rays::RaySet set;
    set.rays.assign(block.begin(), block.end());
    set.query = hits.occluded.empty() ? rays::Query::kClosestHit : rays::Query::kAnyHit;
    set.may_graze = may_graze;
    set.must_hit = must_hit;
    const rays::TraceInput input(std::move(set));
    const ReferenceHits reference(scene, input, oracle_hits(oracle_for(input.reach()), input));
    rays::TraceResults results = rays::make_results(input);
    std::vector<std::string_view> faults;
    if (auto* any = std::get_if<rays::AnyHits>(&results)) {
      any->assign(hits.occluded.begin(), hits.occluded.end());
    } else {
      faults.resize(block.size());
      auto& answers = std::get<accel::HitBuffer>(results);
      for (std::size_t i = 0; i < block.size(); ++i) {
        Answer answer = answer_of(scene, block[i], hits, i);
        if (answer.fault.empty() && !answer.primitive_known) {
          find_primitive(block[i], reference.hits()[i], answer);
        }
        answers.t()[i] = answer.hit.t;
        answers.primitive()[i] = answer.hit.primitive;
        faults[i] = answer.fault;
      }
    }
    differ.compare(reference, results, classes, faults);
    verified += block.size();
  }

  /// Returns an oracle whose boxes are padded for rays from that distance, rounded up to a power of
  /// two so that a few builds suffice for any rays.
  const accel::oracle::Oracle& oracle_for(double reach) {
    if (!oracle || reach > oracle_reach) {
      const double least = std::max<double>(reach, scene.bounds.largest_coordinate());
      oracle_reach = least > 0.0 ? std::exp2(std::ceil(std::log2(least))) : 1.0;
      oracle.emplace(scene, oracle_reach);
    }
    return *oracle;
  }

  /// Finds the primitive at the claim's place: the oracle's if it lies there, otherwise the first
  /// of the nearest primitives.
  void find_primitive(const accel::Ray& ray, const std::optional<accel::oracle::ExactHit>& expected,
                      Answer& answer) {
    const auto contact_with = [&](scenes::PrimitiveId id) {
      return contact(scene, ray, {answer.hit.t, id});
    };
    if (expected && contact_with(expected->primitive).is_on_primitive()) {
      answer.hit.primitive = expected->primitive;
      return;
    }
    if (faults_found >= kEnoughFaults || searched >= kPrimitiveBudget) {
      answer.fault = kNotSearched;
      return;
    }
    searched += scene.primitives.size();
    double nearest = std::numeric_limits<double>::infinity();  // in tolerances
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const Contact found = contact_with(id);
      const double distance = found.offset / found.tolerance;
      if (distance >= nearest) continue;
      nearest = distance;
      answer.hit.primitive = id;
    }
    if (nearest <= 1.0) return;
    ++faults_found;
    answer.fault = kNowhere;
  }

  const scenes::Scene& scene;
  Differ differ;
  std::optional<accel::oracle::Oracle> oracle{};
  double oracle_reach = 0.0;
  bool may_graze = false;
  bool must_hit = false;
  std::size_t verified = 0;        ///< rays
  std::uint64_t faults_found = 0;  ///< by searching for a surface
  std::uint64_t searched = 0;      ///< number of primitives
};

ClaimVerifier::ClaimVerifier(const scenes::Scene& scene, OnMismatch on_mismatch)
    : state_(std::make_unique<State>(scene, std::move(on_mismatch))) {}
ClaimVerifier::~ClaimVerifier() = default;
ClaimVerifier::ClaimVerifier(ClaimVerifier&&) noexcept = default;

void ClaimVerifier::judge_as(const rays::RaySet& rays) {
  state_->may_graze = rays.may_graze;
  state_->must_hit = rays.must_hit;
}

void ClaimVerifier::add(std::span<const accel::Ray> rays, const rays::ClaimedHits& hits,
                        std::span<DiffClass> classes) {
  if (hits.size() != rays.size() || (!classes.empty() && classes.size() != rays.size())) {
    throw std::logic_error(fmt::format("there are {} rays, {} hits and {} classes", rays.size(),
                                       hits.size(), classes.size()));
  }
  state_->require_valid_part(rays, hits);
  for (std::size_t first = 0; first < rays.size(); first += kReferencesAtOnce) {
    const std::size_t count = std::min(kReferencesAtOnce, rays.size() - first);
    state_->add_block(rays.subspan(first, count), hits.part(first, count),
                      classes.empty() ? classes : classes.subspan(first, count));
  }
}

DiffReport ClaimVerifier::finish() { return state_->differ.finish(); }

}  // namespace beambench::verify
