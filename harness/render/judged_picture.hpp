#pragma once
// Whole pictures are right when every answer is that they rest on.

#include <string_view>
#include <vector>

#include "harness/render/recorded_picture.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::render {

/// The rays of one kind, and how they were answered.
struct JudgedRays {
  std::string_view kind;  ///< "eye", or one of kFollowingRayNames
  rays::Question question;
  verify::DiffReport report;
};

/// Judges every ray that the structure was asked for a picture, each kind (and query) as a list of
/// its own; first the eye's, whose true hits are `eye`. Kinds that there are none of are left out.
std::vector<JudgedRays> judge_picture(const verify::ReferenceHits& eye, RecordedPicture picture,
                                      accel::Conformance conformance);

/// All of them together: counts added up, the worst verdict, no examples.
verify::DiffReport sum_of(const std::vector<JudgedRays>& judged);

}  // namespace beambench::render
