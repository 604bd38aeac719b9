#include "harness/thesis/cluster/mpi_session.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <mpi.h>

#include "harness/base/messages.hpp"

namespace beambench::cluster {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Time limit for the end of a process other than the producer, in multiples of the timeout.
constexpr double kLongestEnd = 2.0;

void report(const std::string& message) {
  base::report_error("beambench-cluster", message, base::kInvalidInput);
}

/// Sleeps. Returns whether to continue: false once a stop has been requested.
bool sleep_for(const std::stop_token& stop, Seconds time) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait_for(lock, stop, time, [] { return false; });
  return !stop.stop_requested();
}

/// Unless this object is destroyed in time, ends the process with a message; mpirun then ends the
/// others. Used for MPI calls that wait for all processes without a time limit.
class Deadline {
 public:
  Deadline(double seconds, std::string message, int exit_code)
      : thread_([=, message = std::move(message)](const std::stop_token& stop) {
          if (!sleep_for(stop, Seconds(seconds))) return;
          report(message);
          std::_Exit(exit_code);
        }) {}

 private:
  std::jthread thread_;
};

}  // namespace

/// Sends signs of life in a separate communicator, which only its thread uses until `end`.
class MpiSession::SignsOfLife {
 public:
  explicit SignsOfLife(double timeout)
      : timeout_(timeout), interval_(std::min(1.0, timeout / 8.0)) {
    MPI_Comm_dup(MPI_COMM_WORLD, &processes_);
    MPI_Comm_rank(processes_, &self_);
    int count = 0;
    MPI_Comm_size(processes_, &count);
    if (!is_producer()) count = kProducer + 1;  // it receives signs only from the producer
    for (ProcessId process = 0; process < count; ++process) {
      if (process != self_) others_.push_back({process, Clock::now()});
    }
    thread_ = std::jthread([this](const std::stop_token& stop) {
      while (sleep_for(stop, Seconds(interval_))) {
        send(kAlive);
        receive();
        require_others();
      }
    });
  }

  void allow_silence() { silence_is_allowed_ = true; }

  bool is_producer() const { return self_ == kProducer; }

  /// Waits until the producer has reported to the other processes that everything is written.
  void end() {
    thread_.request_stop();
    thread_.join();
    if (is_producer()) return send(kOver);
    Clock::time_point last_sent = Clock::now();
    for (receive(); !is_over_; receive()) {
      require_others();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (Seconds(Clock::now() - last_sent).count() < interval_) continue;
      send(kAlive);
      last_sent = Clock::now();
    }
  }

 private:
  enum Sign { kAlive, kOver };
  struct Other {
    ProcessId process;
    Clock::time_point last_heard;
  };

  void send(Sign sign) {
    for (const Other& other : others_) {
      MPI_Request request = MPI_REQUEST_NULL;
      MPI_Isend(nullptr, 0, MPI_BYTE, other.process, sign, processes_, &request);
      MPI_Request_free(&request);  // contains no bytes that would have to be kept
    }
  }

  void receive() {
    for (Other& other : others_) {
      MPI_Status coming;
      for (int there = is_there(other, coming); there != 0; there = is_there(other, coming)) {
        MPI_Recv(nullptr, 0, MPI_BYTE, other.process, coming.MPI_TAG, processes_,
                 MPI_STATUS_IGNORE);
        other.last_heard = Clock::now();
        if (coming.MPI_TAG == kOver) is_over_ = true;
      }
    }
  }

  int is_there(const Other& other, MPI_Status& coming) {
    int there = 0;
    MPI_Iprobe(other.process, MPI_ANY_TAG, processes_, &there, &coming);
    return there;
  }

  void require_others() {
    if (silence_is_allowed_ || is_over_) return;
    for (const Other& other : others_) {
      if (Seconds(Clock::now() - other.last_heard).count() < timeout_) continue;
      report(
          fmt::format("process {} was silent for {} s, and the run cannot continue without it; "
                      "existing files are complete; check that its machine is running and "
                      "reachable, or use a longer --timeout",
                      other.process, timeout_));
      abort(base::kInvalidInput);
    }
  }

  double timeout_;
  double interval_;
  MPI_Comm processes_ = MPI_COMM_NULL;
  ProcessId self_ = 0;
  std::vector<Other> others_;
  std::atomic<bool> silence_is_allowed_ = false;
  bool is_over_ = false;
  std::jthread thread_;  // declared last, because it uses the other members
};

MpiSession::MpiSession(int& argc, char**& argv, double timeout)
    : timeout_(timeout), watchdog_(kLongestEnd * timeout) {
  const Deadline deadline(
      timeout,
      fmt::format("the processes did not find each other within {} s; check that all machines are "
                  "running and reachable, or use a longer --timeout",
                  timeout),
      base::kInvalidInput);
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_MULTIPLE, &provided);
  if (provided == MPI_THREAD_MULTIPLE) signs_ = std::make_unique<SignsOfLife>(timeout);
}

MpiSession::~MpiSession() {
  if (!signs_) {
    MPI_Finalize();
    return;
  }
  signs_->end();
  watchdog_.require_end();
  // The producer gives up first, because it has written all files.
  const Deadline deadline(
      signs_->is_producer() ? timeout_ : kLongestEnd * timeout_,
      fmt::format("a process did not end within {} s; all requested files are written", timeout_),
      base::kSuccess);
  MPI_Finalize();
}

void MpiSession::allow_silence() {
  if (signs_) signs_->allow_silence();
}

void MpiSession::abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::_Exit(exit_code);
}

}  // namespace beambench::cluster
