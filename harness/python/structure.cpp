// Builds structures and traces rays through them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/core/tree_quality.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/python/arrays.hpp"
#include "harness/python/bindings.hpp"
#include "harness/python/interruption.hpp"
#include "harness/python/scene_handle.hpp"
#include "harness/python/stoppable_queries.hpp"
#include "harness/python/structure_handle.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::python {

StructureHandle build(std::shared_ptr<const scenes::Scene> scene, const std::string& spec,
                      int threads) {
  const accel::StructureChoice choice = accel::registry().choose(parse_spec(spec));
  accel::Workload workload = accel::usual_workload(*scene);
  workload.threads = threads;
  auto accelerator = choice.build(*scene, workload);
  return {std::make_shared<const BuiltStructure>(
      BuiltStructure{std::move(scene), choice, std::move(accelerator), threads})};
}

namespace {

using Counts = std::map<std::string, std::uint64_t, std::less<>>;
/// t, primitive, counters.
using Hits = std::tuple<ArrayOut<float>, ArrayOut<std::uint32_t>, std::optional<Counts>>;

/// Returns hits as two arrays of the same shape, which share the buffer's memory.
Hits hits_of(std::shared_ptr<accel::HitBuffer> buffer, std::initializer_list<std::size_t> shape,
             const std::optional<accel::WorkCounters>& counters) {
  const nb::capsule owner = keep(buffer);
  std::optional<Counts> counts;
  if (counters) counts = counters->by_name();
  return {ArrayOut<float>(buffer->t(), shape, owner),
          ArrayOut<std::uint32_t>(buffer->primitive(), shape, owner), std::move(counts)};
}

std::optional<accel::WorkCounters> counters_if(bool wanted) {
  return wanted ? std::make_optional<accel::WorkCounters>() : std::nullopt;
}
accel::WorkCounters* pointer_to(std::optional<accel::WorkCounters>& counters) {
  return counters ? &*counters : nullptr;
}

/// Calls `trace(part, first)` for parts of a list, and handles Python's signals in between.
template <class Trace>
void trace_in_parts(std::span<const accel::Ray> rays, const Trace& trace) {
  PartSize size;
  for (std::size_t first = 0; first < rays.size();) {
    const std::size_t count = std::min(size.rays(), rays.size() - first);
    const base::Stopwatch watch;
    trace(rays.subspan(first, count), first);
    size.adapt(watch.seconds());
    first += count;
    check_signals();
  }
}

/// Throws InputError if there are too many rays: the width of a hit buffer is an int.
void require_count(std::size_t rays) {
  constexpr std::size_t kMax = std::numeric_limits<int>::max();
  if (rays <= kMax) return;
  throw InputError(fmt::format("there are {} rays; pass at most {} at once", rays, kMax));
}

Hits closest_hits(const StructureHandle& structure, const RaysIn& given, bool counting) {
  const std::span<const accel::Ray> rays = rays_of(given);
  auto counters = counters_if(counting);
  std::shared_ptr<accel::HitBuffer> hits;
  require_count(rays.size());
  {
    const nb::gil_scoped_release released;
    require_valid_rays(rays);
    hits = std::make_shared<accel::HitBuffer>(static_cast<int>(rays.size()), 1, 1);
    trace_in_parts(rays, [&](std::span<const accel::Ray> part, std::size_t first) {
      accel::HitBuffer found(static_cast<int>(part.size()), 1, 1);
      structure.built->accelerator->closest_hits(accel::RayBatch{part}, found,
                                                 {pointer_to(counters)});
      std::copy_n(found.t(), part.size(), hits->t() + first);
      std::copy_n(found.primitive(), part.size(), hits->primitive() + first);
    });
  }
  return hits_of(std::move(hits), {rays.size()}, counters);
}

std::tuple<ArrayOut<std::uint8_t>, std::optional<Counts>> any_hits(const StructureHandle& structure,
                                                                   const RaysIn& given,
                                                                   bool counting) {
  const std::span<const accel::Ray> rays = rays_of(given);
  auto counters = counters_if(counting);
  std::vector<std::uint8_t> hits(rays.size());
  {
    const nb::gil_scoped_release released;
    require_valid_rays(rays);
    trace_in_parts(rays, [&](std::span<const accel::Ray> part, std::size_t first) {
      structure.built->accelerator->any_hits(accel::RayBatch{part},
                                             std::span(hits).subspan(first, part.size()),
                                             {pointer_to(counters)});
    });
  }
  std::optional<Counts> counts;
  if (counters) counts = counters->by_name();
  return {array_of(std::move(hits)), std::move(counts)};
}

struct TracedImage {
  std::shared_ptr<accel::HitBuffer> hits;
  std::optional<accel::WorkCounters> counters;
};

Hits trace_image(const StructureHandle& structure, const ImageChoice& choice,
                 std::optional<int> threads, bool counting) {
  TracedImage traced;
  {
    const nb::gil_scoped_release released;
    traced = result_of([built = structure.built, image = image_of(choice), counting,
                        threads](const StopRequest& stop) {
      const accel::PrimaryRays rays = image.rays();
      TracedImage result{
          std::make_shared<accel::HitBuffer>(rays.width(), rays.height(), rays.samples()),
          counters_if(counting)};
      StoppableQueries(*built->accelerator, stop)
          .closest_hits(rays, *result.hits,
                        {pointer_to(result.counters), threads.value_or(built->threads)});
      return result;
    });
  }
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const accel::HitBuffer& hits = *traced.hits;
  if (hits.samples() == 1) {
    return hits_of(traced.hits, {size(hits.height()), size(hits.width())}, traced.counters);
  }
  return hits_of(traced.hits, {size(hits.height()), size(hits.width()), size(hits.samples())},
                 traced.counters);
}

Record statistics_of(const StructureHandle& structure) {
  accel::Statistics statistics = structure.built->accelerator->statistics();
  accel::append_quality(*structure.built->accelerator, *structure.built->scene, statistics);
  Record all;
  all["nodes"] = statistics.nodes;
  all["leaves"] = statistics.leaves;
  all["empty_leaves"] = statistics.empty_leaves;
  all["references"] = statistics.references;
  all["depth"] = statistics.depth;
  all["bytes"] = statistics.bytes;
  all["instruction_set"] = statistics.instruction_set;
  for (const auto& [name, value] : statistics.more) all[name.c_str()] = value;
  return all;
}

StructureHandle build_structure(const SceneHandle& handle, const std::string& spec, int threads) {
  const nb::gil_scoped_release released;
  return result_of([scene = handle.scene, spec, threads](const StopRequest&) {
    return build(scene, spec, threads);
  });
}

}  // namespace

void bind_structure(nb::module_& module) {
  nb::class_<StructureHandle>(module, "Structure", "A structure built over a scene.")
      .def_prop_ro(
          "label", [](const StructureHandle& s) { return s.built->choice.label(); },
          "Its name and all parameters.")
      .def_prop_ro("statistics", &statistics_of, "Its statistics, by name.")
      .def("closest_hits", &closest_hits, nb::arg("rays").noconvert(), nb::arg("counters"),
           "t, primitive and counters of a list of rays.")
      .def("any_hits", &any_hits, nb::arg("rays").noconvert(), nb::arg("counters"),
           "1 or 0 for each ray, and counters.")
      .def("trace_image", &trace_image, nb::arg("image"), nb::arg("threads").none(),
           nb::arg("counters"), "t, primitive and counters of an image.");
  module.def("build_structure", &build_structure, nb::arg("scene"), nb::arg("spec"),
             nb::arg("threads"), "Builds a structure.");
}

}  // namespace beambench::python
