#include "harness/rays/answers.hpp"

#include <algorithm>
#include <limits>

#include "accel/core/trace_on.hpp"

namespace beambench::rays {
namespace {

constexpr std::uint8_t kNoAnswer = 0xFF;

/// Both forms of every query: `counters` is empty or a WorkCounters.
template <class... Counters>
void ask_with(int threads, const accel::Accelerator& structure, const Question& question,
              Answers& answers, Counters&... counters) {
  if (auto* any = std::get_if<AnyHits>(&answers)) {
    structure.any_hits(question.list()->rays, *any, counters...);
  } else if (question.image() != nullptr) {
    accel::trace_on(threads, structure, *question.image(), std::get<accel::HitBuffer>(answers),
                    counters...);
  } else {
    structure.closest_hits(question.list()->rays, std::get<accel::HitBuffer>(answers), counters...);
  }
}

}  // namespace

Answers room_for(const Question& question) {
  if (question.query() == Query::kAnyHit) return AnyHits(question.size(), 0);
  if (const accel::PrimaryRays* image = question.image()) {
    return accel::HitBuffer(image->width(), image->height(), image->samples());
  }
  return accel::HitBuffer(static_cast<int>(question.size()), 1, 1);
}

void poison(Answers& answers) {
  if (auto* any = std::get_if<AnyHits>(&answers)) {
    std::ranges::fill(*any, kNoAnswer);
  } else {
    poison(std::get<accel::HitBuffer>(answers));
  }
}

void poison(accel::HitBuffer& hits) {
  std::fill_n(hits.t(), hits.size(), std::numeric_limits<float>::quiet_NaN());
  std::fill_n(hits.primitive(), hits.size(), scenes::kNoPrimitive - 1);
}

bool is_hit_at(const Answers& answers, std::size_t index) {
  if (const auto* any = std::get_if<AnyHits>(&answers)) return (*any)[index] != 0;
  return std::get<accel::HitBuffer>(answers).get(index).has_value();
}

void ask(const accel::Accelerator& structure, const Question& question, Answers& answers,
         int threads) {
  ask_with(threads, structure, question, answers);
}

void ask(const accel::Accelerator& structure, const Question& question, Answers& answers,
         accel::WorkCounters& counters, int threads) {
  ask_with(threads, structure, question, answers, counters);
}

}  // namespace beambench::rays
