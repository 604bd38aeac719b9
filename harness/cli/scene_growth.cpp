#include "harness/cli/scene_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/base/progress.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cli/text.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"

namespace beambench::cli {
namespace {

/// Aims so near at the limit: a generator may round its size up.
constexpr double kNearLimit = 0.99;

/// A size is not worth a row of its own with less than so many times the primitives of the last.
constexpr double kMinGrowth = 1.02;

struct Row {
  std::string scene;
  std::int64_t size;
  std::size_t primitives;
  std::size_t bytes;
  double seconds;
};

/// A generator, its parameters as they were given, and the one that is its size.
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
      fmt::format("'{}' has no size to grow with; choose from: {}", name, fmt::join(names, ", ")));
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
        fmt::format("'{}': '{}' is the size that --growth changes; leave it out", text, name));
  }
  const auto size = std::find_if(info.parameters.begin(), info.parameters.end(),
                                 [&](const auto& p) { return p.name == info.size_parameter; });
  if (size == info.parameters.end() || size->type != ParameterInfo::Type::kInteger) {
    throw std::logic_error(info.name + " names no integer parameter as its size");
  }
  return {info, std::move(spec), *size};
}

Row measure(const Growing& growing, std::int64_t size) {
  auto given = growing.spec.parameters;
  given.emplace_back(growing.size.name, fmt::format("{}", size));
  const Parameters parameters(growing.info.name, growing.info.parameters, given);
  const base::Stopwatch stopwatch;
  const scenes::Scene scene = growing.info.generate(parameters);
  const double seconds = stopwatch.seconds();
  return {scene.name, size, scene.primitives.size(), scenes::memory_bytes(scene), seconds};
}

/// The sizes of a scene of which nobody has said how fast it grows. Between two sizes, and a little
/// beyond, it is taken to grow by a power of the size; a scene that doubles with each step has
/// growing powers, so that this errs to the low side.
class Sizes {
 public:
  Sizes(const ParameterInfo& parameter, std::size_t limit)
      : least_(static_cast<std::int64_t>(parameter.minimum)),
        most_(static_cast<std::int64_t>(parameter.maximum)),
        limit_(static_cast<double>(limit)) {}

  std::int64_t first() const { return least_; }

  /// The size after the one that has so many primitives; nothing when that would be too large.
  std::optional<std::int64_t> after(std::int64_t size, std::size_t primitives) {
    const Point last{shifted(size), static_cast<double>(primitives)};
    const double power = power_at(last);
    before_ = last;
    // Twice the primitives, or as many as the limit allows.
    const double factor = std::min(2.0, kNearLimit * limit_ / last.primitives);
    const double step = power > 0.0 ? std::pow(factor, 1.0 / power) : 2.0;
    const auto wanted = last.size * std::clamp(step, 1.0, 4.0);
    std::int64_t next = std::llround(std::floor(wanted)) + least_ - 1;
    const double one_more = last.primitives * std::pow((last.size + 1.0) / last.size, power);
    // Where not even one step fits in, it may be a large one; many small ones would tell nothing.
    const bool worth_it = one_more <= limit_ && one_more >= kMinGrowth * last.primitives;
    if (next <= size && (worth_it || power <= 0.0)) next = size + 1;
    next = std::min(next, most_);
    return next > size ? std::optional(next) : std::nullopt;
  }

 private:
  struct Point {
    double size;  // counted from 1
    double primitives;
  };
  double shifted(std::int64_t size) const { return static_cast<double>(size - least_ + 1); }

  double power_at(const Point& last) const {
    if (before_.size == 0.0) return 1.0;
    return std::log(last.primitives / before_.primitives) / std::log(last.size / before_.size);
  }

  std::int64_t least_;
  std::int64_t most_;
  double limit_;
  Point before_{};  // none yet
};

std::vector<Row> measure_all(const Growing& growing, std::size_t limit) {
  std::vector<Row> rows;
  base::Progress progress(1);
  Sizes sizes(growing.size, limit);
  std::optional<std::int64_t> size = sizes.first();
  while (size) {
    progress.start(fmt::format("{}={}", growing.size.name, *size));
    Row row = measure(growing, *size);
    if (row.primitives > limit) break;
    size = sizes.after(*size, row.primitives);
    const bool grown = rows.empty() || row.primitives > rows.back().primitives;
    if (grown) rows.push_back(std::move(row));
  }
  return rows;
}

void print_text(const Growing& growing, const std::vector<Row>& rows) {
  TextTable table({growing.size.name, "primitives", "memory", "a primitive", "seconds"}, 0);
  for (const Row& row : rows) {
    const double each = static_cast<double>(row.bytes) / static_cast<double>(row.primitives);
    table.add({fmt::format("{}", row.size), fmt::format("{}", row.primitives),
               format_bytes(row.bytes), fmt::format("{:.0f} bytes", each),
               fmt::format("{:.4f}", row.seconds)});
  }
  fmt::print("{}\n{}", growing.info.name, table.text());
}

void print_json(const Growing& growing, const std::vector<Row>& rows) {
  nlohmann::ordered_json out{{"scene", growing.info.name}, {"size_parameter", growing.size.name}};
  for (const Row& row : rows) {
    out["sizes"].push_back({{"scene", row.scene},
                            {"size", row.size},
                            {"primitives", row.primitives},
                            {"bytes", row.bytes},
                            {"seconds", row.seconds}});
  }
  fmt::print("{}\n", out.dump(2));
}

/// A label may hold commas, so it is quoted.
void print_csv(const Growing& growing, const std::vector<Row>& rows) {
  fmt::print("generator,parameter,size,primitives,bytes,seconds,scene\n");
  for (const Row& row : rows) {
    fmt::print("{},{},{},{},{},{:.6f},\"{}\"\n", growing.info.name, growing.size.name, row.size,
               row.primitives, row.bytes, row.seconds, row.scene);
  }
}

}  // namespace

void show_growth(const std::string& spec, std::size_t limit, GrowthForm form) {
  const Growing growing = growing_scene(spec);
  const std::vector<Row> rows = measure_all(growing, limit);
  if (rows.empty()) {
    throw InputError(
        fmt::format("already the smallest '{}' has more than {} primitives; raise "
                    "--growth-limit",
                    growing.info.name, limit));
  }
  switch (form) {
    case GrowthForm::kText:
      return print_text(growing, rows);
    case GrowthForm::kJson:
      return print_json(growing, rows);
    case GrowthForm::kCsv:
      return print_csv(growing, rows);
  }
}

}  // namespace beambench::cli
