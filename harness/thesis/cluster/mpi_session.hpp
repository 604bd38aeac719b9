#pragma once
// The use of MPI from start to end, and the end of a run in which a process stops.

#include <memory>

#include "harness/thesis/cluster/transport.hpp"
#include "harness/thesis/cluster/watchdog.hpp"

namespace beambench::cluster {

/// The MPI session of a program, constructed before anything else. If a process or its machine
/// stops, all other processes end within the time limit instead of waiting, with a message on
/// stderr and exit code 2. To detect this whatever the processes are doing, a thread of each
/// process sends signs of life to the producer, and the producer's thread sends them to all others.
/// This requires that MPI allows threads (MPI_THREAD_MULTIPLE); otherwise only the start has a time
/// limit.
class MpiSession {
 public:
  /// `timeout` is the limit in seconds for the start of MPI, for any silence after that, and for
  /// the end of MPI.
  MpiSession(int& argc, char**& argv, double timeout);
  /// The producer announces that it has written everything, and the other processes wait for this;
  /// then all end MPI.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  /// Called on the producer. From then on, other processes may be silent, and the caller handles
  /// silence.
  void allow_silence();

  /// Ends all processes immediately, including those that do not respond.
  [[noreturn]] static void abort(int exit_code);

 private:
  class SignsOfLife;
  double timeout_;
  Watchdog watchdog_;
  std::unique_ptr<SignsOfLife> signs_;
};

}  // namespace beambench::cluster
