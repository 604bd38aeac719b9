#include "harness/thesis/cluster/split/light_ray.hpp"

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

namespace beambench::cluster {
namespace {

/// Visits the transmitted members of a ray in order; the argument may be const.
template <class Ray>
auto members(Ray& light) requires std::same_as<std::remove_const_t<Ray>, LightRay> {
  return std::tie(light.cell, light.number, light.query, light.ray.origin.x, light.ray.origin.y,
                  light.ray.origin.z, light.ray.t_min, light.ray.direction.x, light.ray.direction.y,
                  light.ray.direction.z, light.ray.t_max, light.t, light.best.t,
                  light.best.primitive);
}
template <class Answer>
auto members(Answer& answer) requires std::same_as<std::remove_const_t<Answer>, LightAnswer> {
  return std::tie(answer.number, answer.hit.t, answer.hit.primitive);
}

template <class Each>
std::vector<Each> read_all(std::span<const std::byte> bytes) {
  std::vector<Each> all;
  ByteReader reader(bytes);
  while (!reader.at_end()) reader.get(members(all.emplace_back()));
  return all;
}

}  // namespace

void write_light(const LightRay& ray, Bytes& bytes) { ByteWriter(bytes).put(members(ray)); }

void write_light(const LightAnswer& answer, Bytes& bytes) {
  ByteWriter(bytes).put(members(answer));
}

std::vector<LightRay> read_light_rays(std::span<const std::byte> bytes) {
  std::vector<LightRay> rays = read_all<LightRay>(bytes);
  for (const LightRay& ray : rays) {
    if (ray.query != LightQuery::kClosest && ray.query != LightQuery::kAny) {
      throw ProtocolError("a ray of light with an unknown query");
    }
  }
  return rays;
}

std::vector<LightAnswer> read_light_answers(std::span<const std::byte> bytes) {
  return read_all<LightAnswer>(bytes);
}

LightOutbox::LightOutbox(Transport& transport, const SceneSplit& split)
    : transport_(&transport),
      split_(&split),
      open_rays_(static_cast<std::size_t>(transport.processes())) {}

void LightOutbox::hand_over(const LightRay& ray) {
  write_light(ray, open_rays_[static_cast<std::size_t>(split_->owner(ray.cell))]);
  ++rays_;
}

void LightOutbox::answer(const LightAnswer& answer) {
  write_light(answer, open_answers_);
  ++answers_;
}

void LightOutbox::send(std::size_t least) {
  for (std::size_t i = 0; i < open_rays_.size(); ++i) {
    send(static_cast<ProcessId>(i), Tag::kLight, open_rays_[i], least);
  }
  send(kProducer, Tag::kAnswers, open_answers_, least);
}

void LightOutbox::send(ProcessId to, Tag tag, Bytes& open, std::size_t least) {
  if (open.empty() || open.size() < least) return;
  sent_.add(open.size());
  transport_->send(to, tag, std::exchange(open, {}));
}

}  // namespace beambench::cluster
