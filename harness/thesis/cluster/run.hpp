#pragma once
// A whole run: set-up, leader and followers.

#include <functional>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "harness/render/shading.hpp"
#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/kept_results.hpp"
#include "harness/thesis/cluster/producer.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/transport.hpp"
#include "scenes/base/error.hpp"

namespace beambench::cluster {

/// The request to process 0.
struct ClusterRequest {
  Job job;
  ProducerOptions producer;
  Work work = Work::kBeams;
  bool batch_given = false;  ///< for tiles: equal, not decreasing numbers in the messages
  int block_size = 32;
  render::Shading shading = render::Shading::kPreview;
  std::string picture;  ///< file; empty: none
  /// Keeps finished results until the picture is written; may be null, but not with `job.stored`.
  std::shared_ptr<KeptFolder> kept;
  std::string report;
  std::string tasks;
};

/// Makes the image and writes the requested files, after broadcasting the job. Throws InputError if
/// the scene cannot be loaded or a process does not match; the other processes are shut down first.
ClusterRun lead(const ClusterRequest& request, Transport& transport);

/// Receives the job and works on it until it ends. Reports a failure during set-up to process 0,
/// which ends the run.
void follow(Transport& transport);

/// Calls `set_up` on process 0, and prints its warnings on stderr. If it throws, the other
/// processes are shut down first.
void set_up_producer(Transport& transport,
                     const std::function<void(std::vector<std::string>& warnings)>& set_up);

/// Reports to process 0 why this process cannot work, and waits for the end.
void report_setup_failure(Transport& transport, const std::string& problem);

/// Calls `set_up` on another process and returns its result. After an InputError or std::bad_alloc,
/// reports the problem to process 0, which ends the run, and returns nothing.
template <class SetUp>
std::optional<std::invoke_result_t<SetUp>> set_up_consumer(Transport& transport, SetUp set_up) {
  std::string problem;
  try {
    return set_up();
  } catch (const InputError& error) {
    problem = error.what();
  } catch (const std::bad_alloc&) {
    problem = "out of memory for this scene";
  }
  report_setup_failure(transport, problem);
  return std::nullopt;
}

}  // namespace beambench::cluster
