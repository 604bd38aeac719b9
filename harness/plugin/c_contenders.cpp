#include "harness/plugin/c_contenders.hpp"

#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "accel/core/support.hpp"
#include "harness/plugin/batch_structure.hpp"
#include "harness/plugin/scene_arrays.hpp"
#include "scenes/base/error.hpp"

namespace beambench::plugin {
namespace {

/// Throws unless a table's function returned BEAMBENCH_OK: UnsupportedError if it declined,
/// otherwise PluginError.
void require_ok(int status, std::string_view name, std::string_view what) {
  if (status == BEAMBENCH_OK) return;
  if (status == BEAMBENCH_UNSUPPORTED) {
    throw accel::UnsupportedError(fmt::format("'{}' declines {}", name, what));
  }
  throw PluginError(fmt::format("'{}' failed: {} returned {}", name, what, status));
}

class CTracer final : public BatchTracer {
 public:
  CTracer(const beambench_contender& table, const scenes::Scene& scene)
      : table_(&table), arrays_(scene) {
    require_ok(table.create(&arrays_.view(), &structure_), table.name, "'create' for this scene");
  }
  ~CTracer() override {
    if (structure_ != nullptr) table_->destroy(structure_);
  }

  void closest_hits(const beambench_batch& batch, float* t,
                    std::uint32_t* primitive) const override {
    const int status = table_->closest_hits(structure_, &batch, t, primitive);
    require_ok(status, table_->name, "'closest_hits' of these rays");
  }
  void any_hits(const beambench_batch& batch, std::uint8_t* hits) const override {
    const int status = table_->any_hits == nullptr ? BEAMBENCH_UNSUPPORTED
                                                   : table_->any_hits(structure_, &batch, hits);
    require_ok(status, table_->name, "'any_hits' of these rays");
  }
  accel::Statistics statistics() const override {
    accel::Statistics statistics;
    if (table_->bytes != nullptr) statistics.bytes = table_->bytes(structure_);
    if (table_->version != nullptr) statistics.library_version = table_->version;
    return statistics;
  }
  bool takes_whole_queries() const override { return false; }

 private:
  const beambench_contender* table_;
  SceneArrays arrays_;
  void* structure_ = nullptr;
};

void require_complete(const beambench_contender& table, std::uint32_t index) {
  const auto refuse = [&](std::string_view problem) {
    throw PluginError(fmt::format("has a contender {} {}", index, problem));
  };
  if (table.size < sizeof(beambench_contender)) {
    refuse(fmt::format("whose 'size' is {}; expected sizeof(beambench_contender), {}", table.size,
                       sizeof(beambench_contender)));
  }
  if (table.name == nullptr) refuse("without a name");
  if (table.description == nullptr) refuse("without a description");
  if (table.create == nullptr) refuse("without 'create'");
  if (table.closest_hits == nullptr) refuse("without 'closest_hits'");
  if (table.destroy == nullptr) refuse("without 'destroy'");
  constexpr std::uint32_t kAll = BEAMBENCH_TRIANGLES | BEAMBENCH_SPHERES | BEAMBENCH_CONES;
  if (table.supports == 0 || (table.supports & ~kAll) != 0) {
    refuse(fmt::format("whose 'supports' is {}; expected a sum of BEAMBENCH_TRIANGLES, ...",
                       table.supports));
  }
}

accel::StructureInfo info_of(const beambench_contender& table) {
  const auto has = [&](std::uint32_t kind) { return (table.supports & kind) != 0; };
  return {table.name,
          table.description,
          accel::Conformance::kTolerance,
          {},
          [&table](const scenes::Scene& scene, const Parameters&, const accel::Workload&) {
            return structure_of(std::make_unique<CTracer>(table, scene));
          },
          {.spheres = has(BEAMBENCH_SPHERES),
           .cones = has(BEAMBENCH_CONES),
           .polygons = has(BEAMBENCH_TRIANGLES)}};
}

}  // namespace

std::vector<accel::StructureInfo> structures_of(decltype(&beambench_contenders) contenders) {
  std::uint32_t count = 0;
  const beambench_contender* first = contenders(BEAMBENCH_C_INTERFACE, &count);
  if (first == nullptr || count == 0) {
    throw PluginError(
        fmt::format("has no contenders for version {} of the C interface; build it "
                    "with this beambench's contender.h",
                    BEAMBENCH_C_INTERFACE));
  }
  std::vector<accel::StructureInfo> structures;
  const auto* table = reinterpret_cast<const std::byte*>(first);
  for (std::uint32_t i = 0; i < count; ++i, table += first->size) {  // theirs may be longer
    const auto& contender = *reinterpret_cast<const beambench_contender*>(table);
    require_complete(contender, i);
    structures.push_back(info_of(contender));
  }
  return structures;
}

}  // namespace beambench::plugin
