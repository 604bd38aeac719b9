#pragma once
// Whole pictures: which rays follow the eye's depends on what a structure answers.

#include "accel/core/hit_buffer.hpp"
#include "harness/bench/task.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted.hpp"

namespace beambench::bench {

/// The picture of `render --shade whitted`, on one thread: the eye's rays by what the structure has
/// for images (beams), the rest ray by ray, shading included. Judged is not the picture but every
/// answer that it rests on, reflected, refracted and shadow rays too: a second drawing, with all
/// of them written down, must give the same bits as the timed one.
class PictureTask : public Task {
 public:
  PictureTask(const CellGroup& group, std::uint64_t scene_hash, int core);

  void poison() override;
  void ask(const accel::Accelerator& structure) override;
  CountedWork count(const accel::Accelerator& structure) override;
  std::uint64_t fingerprint() const override;
  Judgment judge(const accel::Accelerator& structure,
                 const accel::StructureChoice& choice) override;

 private:
  QueryPath path_of(const accel::Accelerator&) const override { return QueryPath::kPicture; }
  double measure_harness_ms(QueryPath) override { return shading_ms_; }
  void learn_facts(std::uint64_t scene_hash, int core);
  render::RayCensus draw(const render::Answerers& answerers);

  accel::PrimaryRays rays_;
  render::WhittedOptions options_;
  verify::ReferenceHits eye_reference_;
  accel::HitBuffer eye_;
  render::Image image_;
  double shading_ms_ = 0.0;
};

}  // namespace beambench::bench
