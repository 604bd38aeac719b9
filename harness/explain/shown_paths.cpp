#include "harness/explain/shown_paths.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <tuple>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/inspector_of.hpp"

namespace beambench::explain {
namespace {

/// Adds paths to a table in which equal places and equal beams are stored once.
class PathWriter {
 public:
  explicit PathWriter(PathTable& table) : table_(&table) {}

  /// Adds the path of a single ray. Its first leaves come from the beams that contain the ray.
  void add(const std::vector<accel::TraceStep>& path, std::span<const std::uint32_t> containing,
           std::span<const accel::BeamOutline> beams) {
    std::size_t own = 0;  // the first step of the ray itself
    for (bool goes_on = true; goes_on && own < path.size();) {
      const auto met = std::ranges::find_if(containing, [&](std::uint32_t beam) {
        return beams[beam].kind != accel::BeamKind::kLeaving && beams[beam].node == path[own].index;
      });
      if (met == containing.end()) break;
      goes_on = beams[*met].kind == accel::BeamKind::kNonTerminal;
      add_leaf(*met, path[own]);
      if (goes_on) ++own;
    }
    const auto leaving = std::ranges::find_if(containing, [&](std::uint32_t beam) {
      return beams[beam].kind == accel::BeamKind::kLeaving;
    });
    if (leaving != containing.end() && own == path.size() && own > 0) {
      add_leaf(*leaving, path.back());
    }
    table_->first_beam.push_back(static_cast<std::uint32_t>(table_->beam.size()));
    for (; own < path.size(); ++own) add(path[own]);
    table_->first_step.push_back(static_cast<std::uint32_t>(table_->place.size()));
  }

 private:
  using PlaceKey = std::tuple<std::string_view, std::uint64_t, int, std::array<double, 6>>;

  void add_leaf(std::uint32_t beam, const accel::TraceStep& step) {
    table_->beam.push_back(beam);
    table_->beam_place.push_back(number_of(step));
  }

  void add(const accel::TraceStep& step) {
    table_->place.push_back(number_of(step));
    table_->enter.push_back(static_cast<float>(step.t_enter));
    table_->exit.push_back(static_cast<float>(step.t_exit));
    std::uint32_t omitted = 0;
    std::size_t kept = 0;
    for (const accel::TestedPrimitive& test : step.tests) {
      // Hits are never omitted, because the best of them is the ray's hit.
      if (kept >= kMostTests && !accel::is_hit(test.t)) {
        ++omitted;
        continue;
      }
      ++kept;
      table_->primitive.push_back(test.primitive);
      table_->t.push_back(test.t);
    }
    table_->omitted.push_back(omitted);
    table_->first_test.push_back(static_cast<std::uint32_t>(table_->primitive.size()));
  }

  std::uint32_t number_of(const accel::TraceStep& step) {
    const accel::Box box = step.box.value_or(accel::Box{});
    const auto [entry, is_new] = places_.try_emplace(
        PlaceKey{step.place,
                 step.index,
                 step.level,
                 {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z}},
        static_cast<std::uint32_t>(table_->places.size()));
    if (is_new) {
      table_->places.push_back(
          {std::string(step.place), step.index, step.box.has_value(), {box, step.level}});
    }
    return entry->second;
  }

  PathTable* table_;
  std::map<PlaceKey, std::uint32_t> places_;
};

/// Returns whether a convex polygon contains a point; its edges count as inside.
bool contains(std::span<const glm::dvec2> corners, const glm::dvec2& point) {
  constexpr double kTolerance = 1e-7;  // square pixels
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 edge = corners[(i + 1) % corners.size()] - corners[i];
    const glm::dvec2 to = point - corners[i];
    const double side = edge.x * to.y - edge.y * to.x;
    left |= side > kTolerance;
    right |= side < -kTolerance;
  }
  return !(left && right);
}

/// Returns the beams that contain the first sample of each pixel, in order.
std::vector<std::vector<std::uint32_t>> beams_of_pixels(const accel::PrimaryRays& image,
                                                        std::span<const accel::BeamOutline> beams) {
  std::vector<std::vector<std::uint32_t>> containing(static_cast<std::size_t>(image.width()) *
                                                     static_cast<std::size_t>(image.height()));
  const glm::dvec2 last(image.width() - 1, image.height() - 1);
  for (std::size_t beam = 0; beam < beams.size(); ++beam) {
    const std::vector<glm::dvec2>& corners = beams[beam].corners;
    if (corners.empty()) continue;
    glm::dvec2 low = corners.front();
    glm::dvec2 high = corners.front();
    for (const glm::dvec2& corner : corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    const glm::ivec2 from = glm::clamp(glm::floor(low), glm::dvec2(0.0), last);
    const glm::ivec2 to = glm::clamp(glm::floor(high), glm::dvec2(0.0), last);
    for (int y = from.y; y <= to.y; ++y) {
      for (int x = from.x; x <= to.x; ++x) {
        if (!contains(corners, glm::dvec2(x, y) + image.offsets().front())) continue;
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width()) +
            static_cast<std::size_t>(x);
        containing[pixel].push_back(static_cast<std::uint32_t>(beam));
      }
    }
  }
  return containing;
}

}  // namespace

PathTable follow_image(const accel::Accelerator& structure, const accel::PrimaryRays& image,
                       std::span<const accel::BeamOutline> beams,
                       const std::function<void(double)>& advance) {
  const accel::Inspector& inspector = accel::inspector_of(structure);
  const std::vector<std::vector<std::uint32_t>> containing = beams_of_pixels(image, beams);
  PathTable table;
  PathWriter writer(table);
  std::size_t pixel = 0;
  for (int y = 0; y < image.height(); ++y) {
    advance(static_cast<double>(y) / image.height());
    for (int x = 0; x < image.width(); ++x) {
      writer.add(inspector.path(image.ray(x, y, 0)), containing[pixel++], beams);
    }
  }
  return table;
}

}  // namespace beambench::explain
