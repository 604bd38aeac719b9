#pragma once
// Messages by MPI.

#include <memory>

#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// MPI from its beginning to its end. One for a program, made before anything else.
class MpiSession {
 public:
  MpiSession(int& argc, char**& argv);
  /// Waits for the other processes.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  /// Ends all processes at once, those that hang, too.
  [[noreturn]] static void abort(int exit_code);
};

/// The processes that mpirun started, in a communicator of its own.
class MpiTransport : public Transport {
 public:
  /// How it waits for messages.
  enum class Waiting {
    kSleeping,  ///< looks, and sleeps for a moment: leaves the processor to those that work
    kBlocking   ///< in MPI_Recv, with no time limit: for a simulation, where waiting is exact
  };
  explicit MpiTransport(Waiting waiting);
  /// What has not left by now is given up.
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
  struct Mpi;  // what of MPI it holds
  std::unique_ptr<Mpi> mpi_;
  Waiting waiting_;
  int self_ = 0;
  int processes_ = 1;
};

}  // namespace beambench::cluster
