#pragma once
// What structures answer to a question.

#include <cstdint>
#include <variant>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "harness/rays/question.hpp"

namespace beambench::rays {

/// For each ray of an any-hit question: 1 where there is a hit, 0 where there is none.
using AnyHits = std::vector<std::uint8_t>;
using Answers = std::variant<accel::HitBuffer, AnyHits>;

/// Room for the answers to a question: all misses.
Answers room_for(const Question& question);

/// Overwrites all of them with answers that cannot be: the differ finds every one left unwritten.
void poison(Answers& answers);
void poison(accel::HitBuffer& hits);

/// Is the answer at an index a hit? Poison counts as one.
bool is_hit_at(const Answers& answers, std::size_t index);

/// Asks a structure. `answers` has the shape that `room_for` gives. An image is traced on that many
/// threads (0: one for each core); a list is answered on the calling one.
void ask(const accel::Accelerator& structure, const Question& question, Answers& answers,
         int threads = 1);
void ask(const accel::Accelerator& structure, const Question& question, Answers& answers,
         accel::WorkCounters& counters, int threads = 1);

}  // namespace beambench::rays
