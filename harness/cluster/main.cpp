// beambench-cluster: one image on the processes that mpirun starts.

#include <cstdio>
#include <new>
#include <string>

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cluster/consumer.hpp"
#include "harness/cluster/lead.hpp"
#include "harness/cluster/mpi_transport.hpp"
#include "harness/cluster/request.hpp"
#include "harness/cluster/split/split_run.hpp"
#include "harness/rays/hit_check.hpp"
#include "scenes/error.hpp"

namespace beambench {
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
  if (!request) return kSuccess;
  if (request->job.split_level > 0) {
    fmt::print(stderr, "beambench-cluster: {}\n", summary(lead_split(*request, transport)));
    return kSuccess;
  }
  const ClusterRun run = lead(*request, transport);
  for (const std::string& remark : run.report.remarks) complain(remark, 0);
  fmt::print(stderr, "beambench-cluster: {}\n", summary(run));
  if (run.report.lost.empty()) return kSuccess;
  // They would not come to MPI_Finalize, where everybody would wait for them. All is written.
  MpiSession::abort(kSuccess);
}

int run(int argc, char** argv, Transport& transport) {
  try {
    if (transport.self() == kProducer) return lead_run(argc, argv, transport);
    follow(transport);
    return kSuccess;
  } catch (const LostProcess& error) {
    complain(error.what(), kWrongRequest);
    MpiSession::abort(kWrongRequest);
  } catch (const InputError& error) {
    return complain(error.what(), kWrongRequest);
  } catch (const InvalidHit& error) {  // the others wait for results that will not come
    complain(error.what(), kFound);
    MpiSession::abort(kFound);
  } catch (const std::exception& error) {
    const auto* memory = dynamic_cast<const std::bad_alloc*>(&error);
    complain(memory != nullptr ? "the memory does not suffice; choose a smaller scene or resolution"
                               : fmt::format("internal error, please report it: {}", error.what()),
             kInternalError);
    MpiSession::abort(kInternalError);
  }
}

}  // namespace
}  // namespace beambench

int main(int argc, char** argv) {
  const beambench::MpiSession session(argc, argv);
  beambench::MpiTransport transport(beambench::MpiTransport::Waiting::kSleeping);
  return beambench::run(argc, argv, transport);
}
