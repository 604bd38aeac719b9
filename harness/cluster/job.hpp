#pragma once
// What all processes are told at the beginning, and how they are found to be alike.

#include <cstdint>
#include <span>
#include <string>

#include "harness/cluster/bytes.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/whitted_options.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// The scene's name and how it is subdivided (thesis, section 6.2.3), and the image.
struct Job {
  std::string scene;
  std::string structure;  ///< `beam:max_level=6,...`
  std::string camera;     ///< empty: the scene's first
  int width = 0;          ///< 0: the camera's
  int height = 0;
  int samples = 1;
  bool light = false;  ///< light is followed by the consumers; else they find hits
  render::WhittedOptions whitted;
  int split_level = 0;  ///< the scene is divided by the cells of this level; 0: everybody has it
  double alive_every = 1.0;  ///< seconds between signs of life in long tasks
};

/// The image of a job over its scene, which must outlive it.
rays::ImageOfRays job_image(const Job& job, const scenes::Scene& scene);

/// As bytes, with the version of this program before them.
Bytes write_job(const Job& job);
/// Throws InputError where the producer is another version of this program.
Job read_job(std::span<const std::byte> bytes);

/// What must be the same in all processes, for a beam to mean the same.
struct Identity {
  std::uint64_t scene = 0;  ///< fingerprint of all that can be seen: shapes, looks, lights, cameras
  std::uint64_t nodes = 0;
  std::uint64_t references = 0;
  friend bool operator==(const Identity&, const Identity&) = default;
};

/// Of scene and looks.
std::uint64_t look_hash(const scenes::Scene& scene);

/// What a consumer says of itself when it is ready: that it is like this, or why it cannot work.
struct Introduction {
  std::string host;
  std::string problem;  ///< empty: none
  Identity identity;
  double build_seconds = 0.0;
  std::uint64_t structure_bytes = 0;
};
Bytes write_introduction(const Introduction& introduction);
/// Throws InputError, naming the process, where it comes from another version, has a problem, or is
/// not like `mine`.
Introduction read_introduction(int process, std::span<const std::byte> bytes, const Identity& mine);

}  // namespace beambench::cluster
