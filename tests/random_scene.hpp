#pragma once
// Random scenes and rays for the tests of every module: those of `beambench selftest`.

#include "harness/verify/selftest/test_scenes.hpp"

namespace beambench::tests {

using beambench::verify::random_ray;
using beambench::verify::random_scene;

}  // namespace beambench::tests
