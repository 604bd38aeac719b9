#pragma once
// Ends a stopped process when no other process is left to notice.

namespace beambench::cluster {

/// A child process that kills this one if it does not end in time. While MPI ends, each process
/// waits for the others only at first: if a process is stopped later, only mpirun waits for it,
/// forever.
class Watchdog {
 public:
  /// Forks: construct it before MPI. The child ends with this process, however that ends. If no
  /// child can be created, nothing is watched.
  explicit Watchdog(double seconds);
  ~Watchdog() = default;  ///< continues to watch: static objects are still to be destroyed
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Called when everything is written. From now on this process must end within the time limit.
  void require_end() const;

 private:
  int socket_ = -1;
};

}  // namespace beambench::cluster
