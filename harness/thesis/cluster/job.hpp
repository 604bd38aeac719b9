#pragma once
// The job that is broadcast at the beginning, and the check that all processes agree on it.

#include <cstdint>
#include <span>
#include <string>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/shadows.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "scenes/scene.hpp"

namespace beambench::cluster {

/// The name of the scene, its subdivision (thesis, section 6.2.3), and the image.
struct Job {
  std::string scene;
  std::string structure;              ///< `beam:max_level=6,...`
  std::string camera;                 ///< empty: the scene's first camera
  rays::Resolution resolution{0, 0};  ///< 0: the camera's own
  int samples = 1;
  bool light = false;  ///< consumers send light; otherwise hits
  render::WhittedOptions whitted;
  int split_level =
      0;  ///< level of the cells that divide the scene; 0: every process has the whole scene
  SceneDivision division = SceneDivision::kPrimitives;  ///< the division of those cells
  std::string work;                                     ///< the kind of tasks, for kept results
  std::string stored;  ///< folder in which every process keeps its results; empty: results are sent
  double heartbeat_interval = 1.0;  ///< seconds between heartbeats in long tasks
};

/// Returns the structure of a job with its parameters. Throws InputError if it is not `beam`.
accel::StructureChoice beam_choice(const Job& job);

/// Returns the image of a job over its scene, which must outlive the image.
rays::ImageOfRays job_image(const Job& job, const scenes::Scene& scene);

/// Encodes the job, preceded by the version of this program.
Bytes write_job(const Job& job);
/// Reads a job. Throws InputError if the producer is another version of this program.
Job read_job(std::span<const std::byte> bytes);

/// The properties that must be equal in all processes, so that a beam has the same meaning in each.
struct Identity {
  std::uint64_t scene = 0;  ///< hash of everything visible: primitives, surfaces, lights, cameras
  std::uint64_t primitives = 0;
  std::uint64_t nodes = 0;  ///< of the whole scene's octree; 0 if no process has this octree
  std::uint64_t references = 0;
  friend bool operator==(const Identity&, const Identity&) = default;
};

/// Returns the hash of the scene and everything that shading depends on.
std::uint64_t visible_hash(const scenes::Scene& scene);

/// The message of a process after set-up: its identity, or the reason why it cannot work.
struct ReadyReport {
  std::string host;
  std::string problem;  ///< empty: no problem
  Identity identity;
  double build_seconds = 0.0;
  std::uint64_t structure_bytes = 0;
};
Bytes write_ready_report(const ReadyReport& ready_report);
/// Reads the report. Throws InputError naming the process if it has another version, a problem or
/// another identity.
ReadyReport read_ready_report(int process, std::span<const std::byte> bytes, const Identity& mine);

/// Returns this machine's name.
std::string host_name();

}  // namespace beambench::cluster
