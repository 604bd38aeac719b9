#pragma once
// Random scenes and rays for the tests of every room: those of `beambench selftest`.

#include "harness/selftest/random_scene.hpp"

namespace beambench::testing {

using beambench::random_ray;
using beambench::random_scene;

}  // namespace beambench::testing
