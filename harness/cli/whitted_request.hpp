#pragma once
// What commands that trace whole pictures ask for.

#include <string>

#include <CLI/CLI.hpp>

#include "harness/base/progress.hpp"
#include "harness/render/whitted_picture.hpp"

namespace beambench::cli {

struct WhittedRequest {
  std::string shadows = "rays";
  int max_depth = render::WhittedOptions{}.max_depth;
  double least_weight = 0.0;
  int threads = 0;
};

/// Adds --shadows, --depth and --least-weight.
void add_light_options(CLI::App& command, WhittedRequest& request);
/// The same and --threads.
void add_whitted_options(CLI::App& command, WhittedRequest& request);

/// Throws InputError for a wrong name of a shadow method.
render::WhittedOptions whitted_options(const WhittedRequest& request);

/// `whitted_picture` on as many threads as asked for, with progress.
render::WhittedPicture watched_picture(const render::Whitted& tracer,
                                       const render::CameraRays& rays, const accel::HitBuffer& hits,
                                       const WhittedRequest& request, base::Progress& progress);

}  // namespace beambench::cli
