// beambench-cluster: one image on the processes that mpirun starts.

#include <cstdio>
#include <new>
#include <string>

#include <fmt/format.h>

#include "harness/base/exit_code.hpp"
#include "harness/cluster/consumer.hpp"
#include "harness/cluster/lead.hpp"
#include "harness/cluster/mpi_transport.hpp"
#include "harness/cluster/request.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/rays/hit_check.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cluster {
namespace {

int complain(const std::string& message, int exit_code) {
  fmt::print(stderr, "beambench-cluster: {}\n", message);
  return exit_code;
}

/// Process 0. The others are told the job, or that there is none.
int lead_run(int argc, char** argv, Transport& transport) {
  std::optional<ClusterRequest> request;
  Bytes job;
  try {
    request = parse_request(argc, argv);
    if (request) job = write_job(request->job);
  } catch (...) {
    transport.broadcast(job);
    throw;
  }
  transport.broadcast(job);
  if (!request) return base::kSuccess;
  if (request->job.split_level > 0) {
    fmt::print(stderr, "beambench-cluster: {}\n", summary(lead_split(*request, transport)));
    return base::kSuccess;
  }
  const ClusterRun run = lead(*request, transport);
  for (const std::string& remark : run.report.remarks) complain(remark, 0);
  fmt::print(stderr, "beambench-cluster: {}\n", summary(run));
  if (run.report.lost.empty()) return base::kSuccess;
  // They would not come to MPI_Finalize, where everybody would wait for them. All is written.
  MpiSession::abort(base::kSuccess);
}

int run(int argc, char** argv, Transport& transport) {
  try {
    if (transport.self() == kProducer) return lead_run(argc, argv, transport);
    follow(transport);
    return base::kSuccess;
  } catch (const LostProcess& error) {
    complain(error.what(), base::kInvalidInput);
    MpiSession::abort(base::kInvalidInput);
  } catch (const InputError& error) {
    return complain(error.what(), base::kInvalidInput);
  } catch (const rays::InvalidHit& error) {  // the others wait for results that will not come
    complain(error.what(), base::kMismatch);
    MpiSession::abort(base::kMismatch);
  } catch (const std::exception& error) {
    const auto* memory = dynamic_cast<const std::bad_alloc*>(&error);
    complain(memory != nullptr ? "the memory does not suffice; choose a smaller scene or resolution"
                               : fmt::format("internal error, please report it: {}", error.what()),
             base::kInternalError);
    MpiSession::abort(base::kInternalError);
  }
}

}  // namespace
}  // namespace beambench::cluster

int main(int argc, char** argv) {
  const beambench::cluster::MpiSession session(argc, argv);
  beambench::cluster::MpiTransport transport(beambench::cluster::MpiTransport::Waiting::kSleeping);
  return beambench::cluster::run(argc, argv, transport);
}
