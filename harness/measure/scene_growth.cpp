#include "harness/measure/scene_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/progress.hpp"
#include "harness/base/stopwatch.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"

namespace beambench::measure {
namespace {

/// The fraction of the limit to aim at: a generator may round its size up.
constexpr double kNearLimit = 0.99;

/// A size gets its own row only if its number of primitives exceeds that of the previous row by
/// this factor.
constexpr double kMinGrowth = 1.02;

/// A generator, the given parameters, and its size parameter.
struct Growing {
  const scenes::SceneInfo& info;
  Spec spec;
  const ParameterInfo& size;
};

[[noreturn]] void refuse_sizeless(const std::string& name) {
  std::vector<std::string> names;
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    if (!info.size_parameter.empty()) names.push_back(info.name);
  }
  throw InputError(
      fmt::format("'{}' has no size parameter; choose from: {}", name, fmt::join(names, ", ")));
}

Growing growing_scene(const std::string& text) {
  if (text.find('/') != std::string::npos || text.starts_with(scenes::mesh::kMeshPrefix))
    refuse_sizeless(text);
  Spec spec = parse_spec(text);
  const scenes::SceneInfo& info = scenes::find_scene(spec.name);
  if (info.size_parameter.empty()) refuse_sizeless(info.name);
  for (const auto& [name, value] : spec.parameters) {
    if (name != info.size_parameter) continue;
    throw InputError(
        fmt::format("'{}': '{}' is the size that --growth changes; remove it", text, name));
  }
  const auto size = std::find_if(info.parameters.begin(), info.parameters.end(),
                                 [&](const auto& p) { return p.name == info.size_parameter; });
  if (size == info.parameters.end() || size->type != ParameterInfo::Type::kInteger) {
    throw std::logic_error(info.name + " names no integer parameter as its size");
  }
  return {info, std::move(spec), *size};
}

GrownScene measure(const Growing& growing, std::int64_t size) {
  auto given = growing.spec.parameters;
  given.emplace_back(growing.size.name, fmt::format("{}", size));
  const Parameters parameters(growing.info.name, growing.info.parameters, given);
  const base::Stopwatch stopwatch;
  const scenes::Scene scene = growing.info.generate(parameters);
  const double seconds = stopwatch.seconds();
  return {scene.name, size, scene.primitives.size(), scenes::memory_bytes(scene), seconds};
}

/// Chooses the sizes of a scene whose growth is unknown. Between two sizes, and a little beyond,
/// the number of primitives is assumed to grow as a power of the size. For a scene that doubles
/// with each step, the powers grow, so the estimates are too low rather than too high.
class Sizes {
 public:
  Sizes(const ParameterInfo& parameter, std::size_t limit)
      : minimum_(static_cast<std::int64_t>(parameter.minimum)),
        maximum_(static_cast<std::int64_t>(parameter.maximum)),
        limit_(static_cast<double>(limit)) {}

  std::int64_t first() const { return minimum_; }

  /// Returns the size after `size`, which has this many primitives; nothing if it would be too
  /// large.
  std::optional<std::int64_t> after(std::int64_t size, std::size_t primitives) {
    const Point last{shifted(size), static_cast<double>(primitives)};
    const double power = power_at(last);
    before_ = last;
    // Aims at twice the primitives, or as many as the limit allows.
    const double factor = std::min(2.0, kNearLimit * limit_ / last.primitives);
    const double step = power > 0.0 ? std::pow(factor, 1.0 / power) : 2.0;
    const auto wanted = last.size * std::clamp(step, 1.0, 4.0);
    std::int64_t next = std::llround(std::floor(wanted)) + minimum_ - 1;
    const double one_more = last.primitives * std::pow((last.size + 1.0) / last.size, power);
    // If the aim is less than one step away, takes one step if the scene grows enough; many small
    // steps would show nothing.
    const bool worth_it = one_more <= limit_ && one_more >= kMinGrowth * last.primitives;
    if (next <= size && (worth_it || power <= 0.0)) next = size + 1;
    next = std::min(next, maximum_);
    return next > size ? std::optional(next) : std::nullopt;
  }

 private:
  struct Point {
    double size;  // numbered from 1
    double primitives;
  };
  double shifted(std::int64_t size) const { return static_cast<double>(size - minimum_ + 1); }

  double power_at(const Point& last) const {
    if (before_.size == 0.0) return 1.0;
    return std::log(last.primitives / before_.primitives) / std::log(last.size / before_.size);
  }

  std::int64_t minimum_;
  std::int64_t maximum_;
  double limit_;
  Point before_{};  // none yet
};

}  // namespace

SceneGrowth measure_growth(const std::string& spec, std::size_t limit, base::Progress& progress) {
  const Growing growing = growing_scene(spec);
  SceneGrowth growth{growing.info.name, growing.size.name, {}};
  Sizes sizes(growing.size, limit);
  std::optional<std::int64_t> size = sizes.first();
  while (size) {
    progress.start(fmt::format("{}={}", growing.size.name, *size));
    GrownScene grown = measure(growing, *size);
    if (grown.primitives > limit) break;
    size = sizes.after(*size, grown.primitives);
    if (growth.sizes.empty() || grown.primitives > growth.sizes.back().primitives) {
      growth.sizes.push_back(std::move(grown));
    }
  }
  if (growth.sizes.empty()) {
    throw InputError(
        fmt::format("even the smallest '{}' has more than {} primitives; raise --growth-limit",
                    growing.info.name, limit));
  }
  return growth;
}

}  // namespace beambench::measure
