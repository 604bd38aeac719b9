#pragma once
// Sends messages via MPI.

#include <memory>

#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// The processes started by mpirun, in a separate communicator.
class MpiTransport : public Transport {
 public:
  /// The method of waiting for messages.
  enum class Waiting {
    kSleeping,  ///< polls and sleeps: leaves the processor to others
    kBlocking   ///< in MPI_Recv, with no time limit: for a simulation, where waiting is exact
  };
  explicit MpiTransport(Waiting waiting);
  /// Messages that have not left yet are lost.
  ~MpiTransport() override;
  MpiTransport(const MpiTransport&) = delete;
  MpiTransport& operator=(const MpiTransport&) = delete;

  ProcessId self() const override { return self_; }
  int processes() const override { return processes_; }
  double seconds() const override;
  void send(ProcessId to, Tag tag, Bytes bytes) override;
  void flush() override;
  std::optional<Message> poll() override;
  std::optional<Message> wait(double seconds) override;
  void broadcast(Bytes& bytes) override;

 private:
  struct Mpi;
  std::unique_ptr<Mpi> mpi_;
  Waiting waiting_;
  int self_ = 0;
  int processes_ = 1;
};

}  // namespace beambench::cluster
