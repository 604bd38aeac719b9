#include "accel/beam/beam_watch.hpp"

namespace beambench::accel::beam {

void CountingBeamWatch::finished() {
  resting();
  const auto nanoseconds = [](Clock::duration duration) {
    return static_cast<std::uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(duration).count());
  };
  constexpr std::array<std::string_view, 3> kBeams{"beams_nonterminal", "beams_occupied",
                                                   "beams_leaving"};
  constexpr std::array<std::string_view, 3> kTimes{"beams_nonterminal_ns", "beams_occupied_ns",
                                                   "beams_leaving_ns"};
  constexpr std::array<std::string_view, 3> kReasons{"rays_after_leaf", "rays_by_handover",
                                                     "rays_by_crowding"};
  std::uint64_t beams = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    beams += kinds_[i];
    counters_->add(kBeams[i], kinds_[i]);
    counters_->add(kTimes[i], nanoseconds(times_[i]));
    counters_->add(kReasons[i], reasons_[i]);
  }
  counters_->add("beams", beams);
  counters_->add("beam_edges", edges_);
  counters_->add("beam_clips", clips_);
  counters_->add("beams_made", made_);
  counters_->add("beams_divided", divided_);
  counters_->add("beams_passed_whole", passed_whole_);
  counters_->add("neighbor_searches", neighbor_searches_);
  counters_->add("samples_leaving", left_);
  counters_->add("samples_in_leaves", tested_);
}

}  // namespace beambench::accel::beam
