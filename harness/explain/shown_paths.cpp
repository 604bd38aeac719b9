#include "harness/explain/shown_paths.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/inspector_of.hpp"

namespace beambench::explain {
namespace {

/// Adds paths to a table, in which places and beams that are equal are stored once.
class PathWriter {
 public:
  explicit PathWriter(PathTable& table) : table_(&table) {}

  void add(const accel::SampleSteps& path) {
    for (const accel::BeamPassage& beam : path.beams) table_->beam.push_back(number_of(beam));
    table_->first_beam.push_back(static_cast<std::uint32_t>(table_->beam.size()));
    for (const accel::TraceStep& step : path.steps) add(step);
    table_->first_step.push_back(static_cast<std::uint32_t>(table_->place.size()));
  }

 private:
  using PlaceKey = std::tuple<std::string, std::uint64_t, int, std::array<double, 6>>;
  using BeamKey = std::tuple<std::uint32_t, int, std::vector<double>>;

  void add(const accel::TraceStep& step) {
    Place place{std::string(step.place),
                step.index,
                step.box.has_value(),
                {step.box.value_or(accel::Box{}), step.level}};
    table_->place.push_back(number_of(std::move(place)));
    table_->enter.push_back(static_cast<float>(step.t_enter));
    table_->exit.push_back(static_cast<float>(step.t_exit));
    std::uint32_t omitted = 0;
    std::size_t kept = 0;
    for (const accel::TestedPrimitive& test : step.tests) {
      // Hits are never omitted: the best of them is the ray's.
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

  std::uint32_t number_of(Place place) {
    const accel::Box& box = place.cell.box;
    const auto [entry, is_new] = places_.try_emplace(
        PlaceKey{place.word,
                 place.index,
                 place.cell.level,
                 {box.lower.x, box.lower.y, box.lower.z, box.upper.x, box.upper.y, box.upper.z}},
        static_cast<std::uint32_t>(table_->places.size()));
    if (is_new) table_->places.push_back(std::move(place));
    return entry->second;
  }

  std::uint32_t number_of(const accel::BeamPassage& beam) {
    const std::uint32_t place = number_of(Place{"leaf", beam.node, true, {beam.cell, beam.level}});
    std::vector<double> outline;
    for (const glm::dvec2& corner : beam.corners)
      outline.insert(outline.end(), {corner.x, corner.y});
    const auto [entry, is_new] =
        beams_.try_emplace(BeamKey{place, static_cast<int>(beam.kind), std::move(outline)},
                           static_cast<std::uint32_t>(table_->beams.size()));
    if (is_new) {
      table_->beams.push_back({beam.kind, place, beam.corners, beam.samples, beam.cuts});
    }
    return entry->second;
  }

  PathTable* table_;
  std::map<PlaceKey, std::uint32_t> places_;
  std::map<BeamKey, std::uint32_t> beams_;
};

}  // namespace

PathTable follow_image(const accel::Accelerator& structure, const accel::PrimaryRays& image,
                       const std::function<void(double)>& advance) {
  const accel::Inspector& inspector = accel::inspector_of(structure);
  PathTable table;
  PathWriter writer(table);
  for (int y = 0; y < image.height(); ++y) {
    advance(static_cast<double>(y) / image.height());
    for (int x = 0; x < image.width(); ++x) writer.add(inspector.path(image, x, y, 0));
  }
  return table;
}

}  // namespace beambench::explain
