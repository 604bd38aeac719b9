#include "harness/plugin/guarded_structure.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace beambench::plugin {
namespace {

/// Forwards every call to the plug-in's structure.
class GuardedStructure : public accel::Accelerator {
  template <class Query>
  decltype(auto) call(Query&& query) const {
    return foreign_call(file_, when_queried_, std::forward<Query>(query));
  }

  void require_primitive(scenes::PrimitiveId id) const {
    if (id < primitives_) return;
    throw PluginError(
        fmt::format("the plug-in {}: structure '{}' returned an invalid hit: primitive {}, but the "
                    "scene has {} of them",
                    file_, name_, id, primitives_));
  }
  std::optional<accel::Hit> checked(const std::optional<accel::Hit>& hit) const {
    if (hit) require_primitive(hit->primitive);
    return hit;
  }
  std::vector<accel::BeamPlace> checked(std::vector<accel::BeamPlace> places,
                                        std::size_t rays) const {
    const auto is_valid = [](const accel::BeamPlace& place) {
      return place.way <= accel::BeamPlace::Way::kHandedOver &&
             place.side < accel::BeamPlace::kSides;
    };
    if (!places.empty() && (places.size() != rays || !std::ranges::all_of(places, is_valid))) {
      throw PluginError(
          fmt::format("the plug-in {}: structure '{}' returned invalid places of rays in its beams",
                      file_, name_));
    }
    return places;
  }

 public:
  GuardedStructure(std::unique_ptr<accel::Accelerator> structure, const scenes::Scene& scene,
                   std::string file, std::string name, Activity& activity)
      : structure_(std::move(structure)),
        primitives_(scene.primitives.size()),
        file_(std::move(file)),
        name_(std::move(name)),
        when_queried_("when '" + name_ + "' was queried"),
        activity_(&activity) {}
  GuardedStructure(const GuardedStructure&) = delete;
  GuardedStructure& operator=(const GuardedStructure&) = delete;

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters* counters) const override {
    return checked(call([&] { return structure_->closest_hit(ray, counters); }));
  }
  bool any_hit(const accel::Ray& ray, accel::WorkCounters* counters) const override {
    return call([&] { return structure_->any_hit(ray, counters); });
  }
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters* counters) const override {
    call([&] { structure_->trace(rays, buffer, counters); });
  }
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override {
    call([&] { structure_->closest_hits(batch, buffer, counters); });
  }
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters* counters) const override {
    call([&] { structure_->any_hits(batch, hits, counters); });
  }
  void trace_shared(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override {
    call([&] { structure_->trace_shared(rays, buffer, counters); });
  }

  std::vector<accel::TraceStep> explain(const accel::Ray& ray) const override {
    std::vector<accel::TraceStep> steps = call([&] { return structure_->explain(ray); });
    for (const accel::TraceStep& step : steps) {
      for (const accel::TestedPrimitive& test : step.tests) require_primitive(test.primitive);
    }
    return steps;
  }
  std::vector<accel::BeamOutline> beam_outlines(const accel::PrimaryRays& rays) const override {
    return call([&] { return structure_->beam_outlines(rays); });
  }
  std::vector<accel::BeamPlace> beam_places(const accel::PrimaryRays& rays) const override {
    return checked(call([&] { return structure_->beam_places(rays); }), rays.count());
  }
  std::vector<accel::BeamPlace> beam_places(const accel::RayBatch& batch) const override {
    return checked(call([&] { return structure_->beam_places(batch); }), batch.rays.size());
  }
  std::vector<accel::Box> occupied_cells() const override {
    return call([&] { return structure_->occupied_cells(); });
  }
  accel::Statistics statistics() const override {
    return call([&] { return structure_->statistics(); });
  }

  ~GuardedStructure() override {
    structure_.reset();
    activity_->clear(Activity::Line::kForeign);
  }

 private:
  std::unique_ptr<accel::Accelerator> structure_;
  std::size_t primitives_;
  std::string file_;
  std::string name_;
  std::string when_queried_;
  Activity* activity_;
};

/// A plug-in's function that builds a structure, guarded. It is timed: texts are made beforehand or
/// after an error.
class GuardedBuild {
 public:
  GuardedBuild(const accel::StructureInfo& info, Activity& activity)
      : build_(info.build),
        file_(info.origin),
        name_(info.name),
        building_(fmt::format("{}: building '{}' over ", file_, name_)),
        querying_(fmt::format("{}: querying '{}' over ", file_, name_)),
        when_built_(fmt::format("when '{}' was built", name_)),
        activity_(&activity) {}

  std::unique_ptr<accel::Accelerator> operator()(const scenes::Scene& scene,
                                                 const Parameters& parameters,
                                                 const accel::Workload& workload) const {
    activity_->write(Activity::Line::kForeign, building_, scene.name);
    auto structure = foreign_call(file_, when_built_, [&] {
      auto built = build_(scene, parameters, workload);
      if (built != nullptr) parameters.require_given_were_read();
      return built;
    });
    if (structure == nullptr) {
      throw PluginError(fmt::format("the plug-in {} built no '{}': its function returned nullptr",
                                    file_, parameters.label()));
    }
    activity_->write(Activity::Line::kForeign, querying_, scene.name);
    return std::make_unique<GuardedStructure>(std::move(structure), scene, file_, name_,
                                              *activity_);
  }

 private:
  decltype(accel::StructureInfo::build) build_;
  std::string file_;
  std::string name_;
  std::string building_;
  std::string querying_;
  std::string when_built_;
  Activity* activity_;
};

}  // namespace

accel::StructureInfo guarded(accel::StructureInfo info, Activity& activity) {
  info.build = GuardedBuild(info, activity);
  return info;
}

}  // namespace beambench::plugin
