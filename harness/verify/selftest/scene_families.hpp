#pragma once
// Families of random scenes whose arithmetic is awkward: flat cones, eyes on surfaces, and more.

#include <array>
#include <cstdint>
#include <string_view>

#include "harness/verify/selftest/subject.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// The families, in the order of the seeds: scene `seed` is of family `seed` % their number.
inline constexpr std::array<std::string_view, 7> kSceneFamilies{
    "flat cones",         // heights down to 1e-9 of the radii, cylinders as flat, in stacks
    "eye on geometry",    // on a sphere, a cone, its rim or tip; on, at the edge or corner of
                          // polygons
    "touching spheres",   // as large as their lattice is wide, and the eye at a contact
    "tiny scale",         // coordinates down to 1e-7: smaller scenes are soon refused
    "coplanar polygons",  // overlapping in one plane, or nearly; now and then the eye is in it
    "needles",            // triangles and cones 1e3 to 1e6 times as long as wide
    "nested",             // spheres, cylinders, boxes in each other, 1e-2 to 1e-6 apart
};

/// A scene of up to 20 primitives with one camera, two lights, and matte, mirroring and transparent
/// surfaces. `kinds` leaves some kinds of primitives out; a family that needs one that is left out
/// makes do with another. The same seed gives the same scene everywhere.
scenes::Scene family_scene(std::uint64_t seed, PrimitiveKinds kinds = {});

}  // namespace beambench::verify
