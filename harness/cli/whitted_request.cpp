#include "harness/cli/whitted_request.hpp"

#include <optional>

#include <tbb/global_control.h>

namespace beambench::cli {

void add_light_options(CLI::App& command, WhittedRequest& request) {
  command
      .add_option("--depth", request.max_depth,
                  "Rays behind one another, the eye's included; 1: no mirrors and no glass")
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  command
      .add_option("--shadows", request.shadows,
                  "rays; cache: the primitive that hid the light last is tested first; "
                  "light-buffer: lists made beforehand for each direction from a light")
      ->capture_default_str();
  command
      .add_option("--least-weight", request.least_weight,
                  "Reflected and refracted rays that are a smaller part of their pixel are not "
                  "traced; 0: all are")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
}

void add_whitted_options(CLI::App& command, WhittedRequest& request) {
  add_light_options(command, request);
  command.add_option("--threads", request.threads, "0: one for each core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
}

render::WhittedOptions whitted_options(const WhittedRequest& request) {
  return {request.max_depth, request.least_weight, render::parse_shadow_method(request.shadows)};
}

render::WhittedPicture watched_picture(const render::Whitted& tracer,
                                       const render::CameraRays& rays, const accel::HitBuffer& hits,
                                       const WhittedRequest& request, base::Progress& progress) {
  std::optional<tbb::global_control> limit;
  if (request.threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(request.threads));
  }
  return render::whitted_picture(tracer, rays, hits, [&](double part) { progress.advance(part); });
}

}  // namespace beambench::cli
