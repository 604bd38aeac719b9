#pragma once
// Asking a structure while the user watches.

#include "harness/progress/progress.hpp"
#include "harness/rays/answers.hpp"

namespace beambench {

/// `ask(structure, question, answers, threads)`; on a terminal with the remaining time, estimated
/// from a few rays asked beforehand.
void watched_ask(const Accelerator& structure, const Question& question, Answers& answers,
                 int threads, Progress& progress);

}  // namespace beambench
