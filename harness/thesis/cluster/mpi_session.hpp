#pragma once
// MPI from its beginning to its end, and what ends a run when a process stops.

#include <memory>

#include "harness/thesis/cluster/transport.hpp"
#include "harness/thesis/cluster/watchdog.hpp"

namespace beambench::cluster {

/// One per program, constructed before anything else. A process that is stopped, or whose machine
/// is, ends the run of all others within the time limit, instead of letting them wait: with a
/// message on stderr and exit code 2. So that this is noticed whatever the others are doing, a
/// thread of each process sends a sign of life to the producer, and the producer's to all, where
/// MPI allows threads (MPI_THREAD_MULTIPLE); where it does not, only the start is limited.
class MpiSession {
 public:
  /// `timeout`: seconds until MPI has started, of silence after that, and until MPI has ended.
  MpiSession(int& argc, char**& argv, double timeout);
  /// The producer announces that it has written everything, for which the other processes wait
  /// here; then all end MPI.
  ~MpiSession();
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  /// On the producer: from now on other processes may be silent; it copes with that itself.
  void allow_silence();

  /// Ends all processes at once, hanging ones included.
  [[noreturn]] static void abort(int exit_code);

 private:
  class SignsOfLife;
  double timeout_;
  Watchdog watchdog_;
  std::unique_ptr<SignsOfLife> signs_;
};

}  // namespace beambench::cluster
