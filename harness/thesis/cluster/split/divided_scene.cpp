#include "harness/thesis/cluster/split/divided_scene.hpp"

#include <cstddef>
#include <utility>

#include "harness/thesis/cluster/split/light_relay.hpp"

namespace beambench::cluster {
namespace {

bool is_hit(const accel::Hit& hit) { return hit.primitive != scenes::kNoPrimitive; }

std::optional<accel::Hit> as_result(const accel::Hit& hit) {
  return is_hit(hit) ? std::optional(hit) : std::nullopt;
}

}  // namespace

DividedScene::DividedScene(const PartTracer& part, LightExchange& exchange,
                           accel::Statistics statistics)
    : part_(&part), exchange_(&exchange), statistics_(std::move(statistics)) {}

std::vector<accel::Hit> DividedScene::hits_of(const accel::RaySource& rays,
                                              LightQuery query) const {
  std::vector<accel::Hit> hits(rays.size(), kNoHit);
  std::vector<LightRay> crossing;
  std::vector<std::size_t> places;  // their indices in `rays`
  rays.for_each([&](std::size_t i, const accel::Ray& ray) {
    const std::optional<PartTracer::Place> begin = part_->beginning(ray);
    if (!begin) return;
    LightRay light{0, 0, query, ray, 0.0, kNoHit};
    const auto [best, exit] = pass(*part_, light, *begin);
    hits[i] = best;
    if (!exit) return;
    light.cell = exit->cell;
    light.t = exit->t;
    light.best = best;
    crossing.push_back(light);
    places.push_back(i);
  });
  const std::vector<accel::Hit> answers = exchange_->nearest_hits(std::move(crossing));
  for (std::size_t i = 0; i < answers.size(); ++i) hits[places[i]] = answers[i];
  return hits;
}

void DividedScene::closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                                const accel::QueryContext&) const {
  std::size_t index = 0;
  for (const accel::Hit& hit : hits_of(rays, LightQuery::kClosest)) {
    hits.set(index++, as_result(hit));
  }
}

void DividedScene::any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                            const accel::QueryContext&) const {
  std::size_t index = 0;
  for (const accel::Hit& hit : hits_of(rays, LightQuery::kAny)) hits[index++] = is_hit(hit) ? 1 : 0;
}

}  // namespace beambench::cluster
