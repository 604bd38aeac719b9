#pragma once
// What commands that trace whole pictures ask for.

#include <string>

#include <CLI/CLI.hpp>

#include "harness/progress/progress.hpp"
#include "harness/shade/whitted_picture.hpp"

namespace beambench {

struct WhittedRequest {
  std::string shadows = "rays";
  int max_depth = WhittedOptions{}.max_depth;
  double least_weight = 0.0;
  int threads = 0;
};

/// Adds --shadows, --depth and --least-weight.
void add_light_options(CLI::App& command, WhittedRequest& request);
/// The same and --threads.
void add_whitted_options(CLI::App& command, WhittedRequest& request);

/// Throws InputError for a wrong name of a shadow method.
WhittedOptions whitted_options(const WhittedRequest& request);

/// `whitted_picture` on as many threads as asked for, with progress.
WhittedPicture watched_picture(const Whitted& tracer, const EyeRays& rays, const HitBuffer& hits,
                               const WhittedRequest& request, Progress& progress);

}  // namespace beambench
