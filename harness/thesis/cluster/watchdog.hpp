#pragma once
// What ends a process that is stopped when no other one is left to notice.

namespace beambench::cluster {

/// A child process that kills this one if it does not end in time. While MPI ends, each process
/// waits for the others only at first: one that is stopped after that is waited for by mpirun
/// alone, for ever.
class Watchdog {
 public:
  /// Forks: construct it before MPI. The child ends with this process, however that ends. Where
  /// there can be no child, nothing is watched.
  explicit Watchdog(double seconds);
  ~Watchdog() = default;  ///< goes on watching: static objects are still to be destroyed
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Everything is written. From now on this process must end within the time.
  void require_end() const;

 private:
  int socket_ = -1;
};

}  // namespace beambench::cluster
