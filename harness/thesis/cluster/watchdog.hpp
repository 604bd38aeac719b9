#pragma once
// Ends a stopped process when no other process is left to notice it.

namespace beambench::cluster {

/// A child process that kills this one if it does not end in time. While MPI ends, processes wait
/// for each other only at first; if a process is stopped later, only mpirun waits for it, forever.
class Watchdog {
 public:
  /// Forks, so construct it before MPI. The child ends with this process, however this process
  /// ends. If a child cannot be created, this process is not watched.
  explicit Watchdog(double seconds);
  ~Watchdog() = default;  ///< keeps watching: static objects are still to be destroyed
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Called when everything has been written. From now on, this process must end within the time
  /// limit.
  void require_end() const;

 private:
  int socket_ = -1;
};

}  // namespace beambench::cluster
