#pragma once
// #include <beambench/verify.hpp>: scenes, rays and the verification of hits, for programs that
// link beambench::verify.

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/registry.hpp"
#include "harness/rays/claimed_hits.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/claim_verifier.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
