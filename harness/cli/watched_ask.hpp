#pragma once
// Asking a structure while the user watches.

#include "harness/base/progress.hpp"
#include "harness/rays/answers.hpp"

namespace beambench::cli {

/// `ask(structure, question, answers, threads)`; on a terminal with the remaining time, estimated
/// from a few rays asked beforehand.
void watched_ask(const accel::Accelerator& structure, const rays::Question& question,
                 rays::Answers& answers, int threads, base::Progress& progress);

}  // namespace beambench::cli
