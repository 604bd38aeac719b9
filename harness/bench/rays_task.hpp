#pragma once
// Rays that are the same whatever is answered: an image's, or a list.

#include "harness/bench/task.hpp"
#include "harness/rays/answers.hpp"

namespace beambench::bench {

class RaysTask : public Task {
 public:
  RaysTask(const CellGroup& group, std::uint64_t scene_hash, int core);

  std::optional<std::string> warning() const override;
  void poison() override { beambench::rays::poison(answers_); }
  void ask(const accel::Accelerator& structure) override;
  CountedWork count(const accel::Accelerator& structure) override;
  std::uint64_t fingerprint() const override;
  Judgment judge(const accel::Accelerator& structure,
                 const accel::StructureChoice& choice) override;

 private:
  QueryPath path_of(const accel::Accelerator& structure) const override;
  double measure_harness_ms(QueryPath path) override;

  const rays::Question& question() const { return reference_.question(); }

  verify::ReferenceHits reference_;
  rays::Answers answers_;
  int core_;
};

}  // namespace beambench::bench
