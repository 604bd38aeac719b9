#pragma once
// The harness's own time within a trace.

#include "harness/rays/answers.hpp"

namespace beambench {

/// What `null` needs to be asked a question, which is to make or read every ray and to write every
/// answer: the median of several traces in milliseconds, after one that is not timed. `answers` is
/// overwritten. `core` is to pin to; -1: any.
double harness_ms(const Scene& scene, const Question& question, Answers& answers, int core);

}  // namespace beambench
