#include "harness/cluster/split/divided_scene.hpp"

#include <cstddef>
#include <utility>

#include "harness/cluster/split/light_relay.hpp"
#include "harness/rays/trace_input.hpp"

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

std::vector<accel::Hit> DividedScene::hits_of(std::span<const accel::Ray> rays,
                                              LightQuery query) const {
  std::vector<accel::Hit> hits(rays.size(), kNoHit);
  std::vector<LightRay> crossing;
  std::vector<std::size_t> places;  // theirs
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<PartTracer::Place> begin = part_->beginning(rays[i]);
    if (!begin) continue;
    LightRay light{0, 0, query, rays[i], 0.0, kNoHit};
    const auto [best, exit] = pass(*part_, light, *begin);
    hits[i] = best;
    if (!exit) continue;
    light.cell = exit->cell;
    light.t = exit->t;
    light.best = best;
    crossing.push_back(light);
    places.push_back(i);
  }
  const std::vector<accel::Hit> answers = exchange_->ask(std::move(crossing));
  for (std::size_t i = 0; i < answers.size(); ++i) hits[places[i]] = answers[i];
  return hits;
}

std::optional<accel::Hit> DividedScene::closest_hit(const accel::Ray& ray,
                                                    accel::WorkCounters*) const {
  return as_result(hits_of({&ray, 1}, LightQuery::kClosest).front());
}

bool DividedScene::any_hit(const accel::Ray& ray, accel::WorkCounters*) const {
  return is_hit(hits_of({&ray, 1}, LightQuery::kAny).front());
}

void DividedScene::trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
                         accel::WorkCounters* counters) const {
  std::vector<accel::Ray> all;
  all.reserve(rays.count());
  for (std::size_t i = 0; i < rays.count(); ++i) all.push_back(rays::ray_at(rays, i));
  closest_hits({all, {}, {}, nullptr}, buffer, counters);
}

void DividedScene::closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                                accel::WorkCounters*) const {
  std::size_t index = 0;
  for (const accel::Hit& hit : hits_of(batch.rays, LightQuery::kClosest)) {
    buffer.set(index++, as_result(hit));
  }
}

void DividedScene::any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                            accel::WorkCounters*) const {
  std::size_t index = 0;
  for (const accel::Hit& hit : hits_of(batch.rays, LightQuery::kAny)) {
    hits[index++] = is_hit(hit) ? 1 : 0;
  }
}

}  // namespace beambench::cluster
