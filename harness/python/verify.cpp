// Verifies the hits of any program.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "harness/python/arrays.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "harness/python/scene_handle.hpp"
#include "harness/rays/claimed_hits.hpp"
#include "harness/verify/claim_verifier.hpp"
#include "harness/verify/diff_report.hpp"

namespace beambench::python {
namespace {

/// The number of rays in a part; signals are handled between two parts. The exact search for the
/// wrong hits of a part takes seconds at most.
constexpr std::size_t kPart = std::size_t{1} << 14U;

/// Returns the array, or an array without rows if none is given.
template <class T>
using Numbers = ArrayIn<T, -1>;
using Points = ArrayIn<float, -1, 3>;

template <class T>
std::span<const T> span_of(const Numbers<T>& numbers) {
  return {numbers.data(), numbers.shape(0)};
}
std::span<const glm::vec3> span_of(const Points& points) {
  return {reinterpret_cast<const glm::vec3*>(points.data()), points.shape(0)};
}

/// t and primitive.
using HitPair = std::optional<std::pair<double, std::uint32_t>>;

template <class AnyHit>
HitPair pair_of(const std::optional<AnyHit>& hit) {
  if (!hit) return std::nullopt;
  return std::pair(static_cast<double>(hit->t), hit->primitive);
}

struct Verified {
  verify::DiffReport report;
  std::vector<std::uint8_t> classes;
};

Verified verify_parts(const scenes::Scene& scene, std::span<const accel::Ray> rays,
                      const rays::ClaimedHits& claims) {
  Verified verified{};
  verified.classes.resize(rays.size());
  verify::ClaimVerifier verifier(scene);
  std::vector<verify::DiffClass> classes(std::min(kPart, rays.size()));
  for (std::size_t first = 0; first < rays.size(); first += kPart) {
    const std::size_t count = std::min(kPart, rays.size() - first);
    verifier.add(rays.subspan(first, count), claims.part(first, count),
                 std::span(classes).first(count));
    std::transform(classes.begin(), classes.begin() + static_cast<std::ptrdiff_t>(count),
                   verified.classes.begin() + static_cast<std::ptrdiff_t>(first),
                   [](verify::DiffClass c) { return static_cast<std::uint8_t>(c); });
    check_signals();
  }
  verified.report = verifier.finish();
  return verified;
}

Record record_of(const verify::Mismatch& mismatch) {
  Record entry;
  entry["index"] = mismatch.index;
  entry["class"] = static_cast<std::size_t>(mismatch.diff_class);
  entry["reason"] = nb::str(mismatch.reason.data(), mismatch.reason.size());
  entry["oracle"] = nb::cast(pair_of(mismatch.oracle));
  entry["exact"] = nb::cast(pair_of(mismatch.exact));
  entry["searched"] = mismatch.searched;
  return entry;
}

Record record_of(const verify::DiffReport& report) {
  Record entry;
  const std::string_view verdict = verify::to_string(report.verdict);
  entry["verdict"] = nb::str(verdict.data(), verdict.size());
  entry["rays"] = report.rays;
  entry["hits"] = report.hits;
  nb::list counts;
  for (const std::uint64_t count : report.counts) counts.append(count);
  entry["counts"] = counts;
  nb::list examples;
  for (const verify::Mismatch& mismatch : report.examples) examples.append(record_of(mismatch));
  entry["examples"] = examples;
  return entry;
}

std::tuple<Record, ArrayOut<std::uint8_t>> verify_claims(
    const SceneHandle& scene, const RaysIn& given, const Numbers<float>& t, const Points& point,
    const Numbers<std::uint32_t>& primitive, const Numbers<std::uint32_t>& triangle,
    const Numbers<std::uint8_t>& occluded) {
  const std::span<const accel::Ray> rays = rays_of(given);
  const rays::ClaimedHits claims{span_of(t), span_of(point), span_of(primitive), span_of(triangle),
                                 span_of(occluded)};
  if (claims.size() != rays.size()) throw InputError("the numbers of hits and rays differ");
  Verified verified;
  {
    const nb::gil_scoped_release released;
    try {
      verified = verify_parts(*scene.scene, rays, claims);
    } catch (const verify::InvalidClaim& fault) {
      throw InputError(ray_fault(fault.index, fault.what()));
    }
  }
  return {record_of(verified.report), array_of(std::move(verified.classes))};
}

std::vector<std::string> class_names() {
  return {verify::kDiffClassNames.begin(), verify::kDiffClassNames.end()};
}

}  // namespace

void bind_verify(nb::module_& module) {
  module.def("class_names", &class_names, "The names of the classes, in order.");
  module.def("verify", &verify_claims, nb::arg("scene"), nb::arg("rays").noconvert(),
             nb::arg("t").noconvert(), nb::arg("point").noconvert(),
             nb::arg("primitive").noconvert(), nb::arg("triangle").noconvert(),
             nb::arg("occluded").noconvert(),
             "A report, and the class of each ray; pass empty arrays for omitted arguments.");
}

}  // namespace beambench::python
