#include "harness/verify/selftest/selftest.hpp"

#include <array>
#include <exception>

namespace beambench::verify {

namespace {

bool supports(const accel::Support& support, NeededRays rays) {
  switch (rays) {
    case NeededRays::kImages:
      return support.images;
    case NeededRays::kSingle:
      return support.single_rays;
    case NeededRays::kSingleAndLists:
      return support.single_rays && support.batches;
    case NeededRays::kAny:
      break;
  }
  return true;
}

}  // namespace

std::span<const Check> selftest_checks() {
  static constexpr std::array<Check, 16> kChecks{{
      {"random scenes", "spheres, cones and polygons anywhere, with varied parameters", false,
       false, NeededRays::kSingle, check_random_scenes},
      {"scene families",
       "flat cones, eyes on surfaces, touching spheres, tiny scale, coplanar polygons, needles, "
       "nested surfaces: images and rays",
       false, false, NeededRays::kAny, check_scene_families},
      {"views",
       "cameras and lights anywhere: images, and the shadow, mirrored and scattered rays of what "
       "they see, with their pencils",
       false, false, NeededRays::kAny, check_views},
      {"smallest scenes", "nothing, one sphere, one cone, one triangle without depth", false, false,
       NeededRays::kSingle, check_smallest_scenes},
      {"images", "the images of five scenes, with one and five samples a pixel", false, false,
       NeededRays::kImages, check_images},
      {"faces, edges, corners", "rays in the planes, lines and points where cells and boxes meet",
       true, true, NeededRays::kSingle, check_faces_edges_corners},
      {"closed meshes", "rays from inside a closed mesh, at edges and vertices: at most 1% leak",
       false, true, NeededRays::kSingle, check_closed_meshes},
      {"degenerate rays", "directions of all lengths, nearly along axes; no interval", true, false,
       NeededRays::kSingle, check_degenerate_rays},
      {"heap", "ten thousand equal primitives in one place: the lowest id is hit", false, false,
       NeededRays::kSingle, check_heap},
      {"lists", "rays get the same hits in a list as alone; with its own arithmetic, correct hits",
       false, false, NeededRays::kSingleAndLists, check_lists},
      {"counting", "counting work does not change results", false, false, NeededRays::kAny,
       check_counting},
      {"two builds", "the same scene gives the same structure, work and results", false, false,
       NeededRays::kAny, check_two_builds},
      {"threads", "four threads at once get the same results as one", false, false,
       NeededRays::kAny, check_threads},
      {"counters", "the counters of each ray are consistent", false, false, NeededRays::kSingle,
       check_counters},
      {"statistics", "the sizes that it reports are consistent", false, false, NeededRays::kAny,
       check_statistics},
      {"explanation", "the traversal that it explains ends at the hit that it finds", false, false,
       NeededRays::kSingle, check_explanation},
  }};
  return kChecks;
}

bool applies(const Check& check, const Subject& subject) {
  if (subject.conformance() == accel::Conformance::kBaseline) return false;
  if (check.of_polygons && !subject.kinds().polygons) return false;
  if (!supports(subject.info().support, check.rays)) return false;
  return subject.conformance() == accel::Conformance::kBitExact || !check.bit_exact_only;
}

CheckOutcome run_check(const Check& check, const Subject& subject, const SelftestEffort& effort) {
  try {
    return check.run(subject, effort);
  } catch (const std::exception& error) {
    return {0, error.what()};
  }
}

}  // namespace beambench::verify
