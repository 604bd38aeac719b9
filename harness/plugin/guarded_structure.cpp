#include "harness/plugin/guarded_structure.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/inspector_of.hpp"

namespace beambench::plugin {
namespace {

/// Guards calls of a structure and of its inspector.
class Guard {
 public:
  Guard(const scenes::Scene& scene, std::string file, std::string name)
      : primitives_(scene.primitives.size()),
        file_(std::move(file)),
        name_(std::move(name)),
        when_queried_("when '" + name_ + "' was queried") {}

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
  std::vector<accel::TraceStep> checked(std::vector<accel::TraceStep> steps) const {
    for (const accel::TraceStep& step : steps) {
      for (const accel::TestedPrimitive& test : step.tests) require_primitive(test.primitive);
    }
    return steps;
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

 private:
  std::size_t primitives_;
  std::string file_;
  std::string name_;
  std::string when_queried_;
};

/// Forwards every call to the inspector of the plug-in's structure.
class GuardedInspector final : public accel::Inspector {
 public:
  GuardedInspector(const accel::Accelerator& structure, const Guard& guard)
      : structure_(&structure), guard_(&guard) {}

  std::vector<accel::TraceStep> path(const accel::Ray& ray) const override {
    return guard_->checked(guard_->call([&] { return shown().path(ray); }));
  }
  accel::SampleSteps path(const accel::PrimaryRays& image, int x, int y,
                          int sample) const override {
    accel::SampleSteps steps = guard_->call([&] { return shown().path(image, x, y, sample); });
    steps.steps = guard_->checked(std::move(steps.steps));
    return steps;
  }
  std::vector<accel::Cell> occupied_cells() const override {
    return guard_->call([&] { return shown().occupied_cells(); });
  }
  /// Not forwarded, because callers rely on the node numbers.
  std::vector<accel::NodeFacts> nodes() const override { return {}; }
  std::optional<std::vector<accel::BeamOutline>> beams(
      const accel::PrimaryRays& image) const override {
    return guard_->call([&] { return shown().beams(image); });
  }
  std::vector<accel::BeamPlace> places(const accel::RaySource& rays) const override {
    return guard_->checked(guard_->call([&] { return shown().places(rays); }), rays.size());
  }

 private:
  const accel::Inspector& shown() const { return accel::inspector_of(*structure_); }

  const accel::Accelerator* structure_;
  const Guard* guard_;
};

/// Forwards every call to the plug-in's structure.
class GuardedStructure : public accel::ForwardingAccelerator {
 public:
  GuardedStructure(std::unique_ptr<accel::Accelerator> structure, const scenes::Scene& scene,
                   std::string file, std::string name, Activity& activity)
      : ForwardingAccelerator(*structure),
        structure_(std::move(structure)),
        guard_(scene, std::move(file), std::move(name)),
        inspector_(*structure_, guard_),
        activity_(&activity) {}
  GuardedStructure(const GuardedStructure&) = delete;
  GuardedStructure& operator=(const GuardedStructure&) = delete;
  ~GuardedStructure() override {
    structure_.reset();
    activity_->clear(Activity::Line::kForeign);
  }

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    guard_.call([&] { structure_->closest_hits(rays, hits, context); });
    // Hits of images and batches are left to the caller's verification.
    if (rays.ray() == nullptr) return;
    if (const auto hit = hits.get(0)) guard_.require_primitive(hit->primitive);
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    guard_.call([&] { structure_->any_hits(rays, hits, context); });
  }
  accel::Statistics statistics() const override {
    return guard_.call([&] { return structure_->statistics(); });
  }
  const accel::Inspector* inspector() const override { return &inspector_; }
  bool update(const scenes::Scene& scene) override {
    return guard_.call([&] { return structure_->update(scene); });
  }

 private:
  std::unique_ptr<accel::Accelerator> structure_;
  Guard guard_;
  GuardedInspector inspector_;
  Activity* activity_;
};

/// A plug-in's function that builds a structure, guarded. It is timed, so messages are made before
/// the call or after an error.
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
