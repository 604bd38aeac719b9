#pragma once
// Rays that are the same whatever is answered: an image's, or a list.

#include "harness/rays/answers.hpp"
#include "harness/sweep/task.hpp"

namespace beambench {

class RaysTask : public Task {
 public:
  RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core);

  std::optional<std::string> warning() const override;
  void poison() override { beambench::poison(answers_); }
  void ask(const Accelerator& structure) override;
  CountedWork count(const Accelerator& structure) override;
  std::uint64_t fingerprint() const override;
  Judgement judge(const Accelerator& structure, const StructureChoice& choice) override;

 private:
  QueryPath path_of(const Accelerator& structure) const override;
  double measure_harness_ms(QueryPath path) override;

  const Question& question() const { return reference_.question(); }

  ReferenceHits reference_;
  Answers answers_;
  int core_;
};

}  // namespace beambench
