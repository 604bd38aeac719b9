#include "harness/python/interruption.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <thread>

#include <nanobind/nanobind.h>
#include <unistd.h>

#include "accel/core/threads.hpp"

namespace beambench::python {
namespace {

constexpr std::chrono::milliseconds kPoll(50);
constexpr std::chrono::seconds kPatience(1);  // for work that checks for stop requests

/// The number of jobs for which no caller is waiting anymore.
std::atomic<int> abandoned{0};

#if defined(__GLIBC__)
/// Exits immediately, because threads of abandoned work must not run into destructors of static
/// objects.
void end_at_once(int status, void*) {
  if (abandoned.load() == 0) return;
  std::fflush(nullptr);
  ::_exit(status);
}
#endif

void cut_off_at_exit() {
#if defined(__GLIBC__)
  static std::once_flag once;
  std::call_once(once, [] { ::on_exit(end_at_once, nullptr); });
#endif
}

/// The state shared by the caller and the thread that does the work.
struct Run {
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  bool is_abandoned = false;
  std::exception_ptr error;
};

void work_on_thread(const std::shared_ptr<Run>& run, std::function<void(const StopRequest&)>& work,
                    const StopRequest& stop) {
  std::exception_ptr error;
  try {
    accel::on_default_threads([&] { work(stop); });
  } catch (...) {
    error = std::current_exception();
  }
  work = nullptr;  // its captures are destroyed before the caller continues
  const std::lock_guard lock(run->mutex);
  run->error = error;
  run->done = true;
  if (run->is_abandoned) --abandoned;
  run->ended.notify_all();
}

}  // namespace

void check_signals() {
  const nanobind::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

void run_apart(std::function<void(const StopRequest&)> work) {
  const auto run = std::make_shared<Run>();
  const StopRequest stop;
  std::thread([run, stop, work = std::move(work)]() mutable {
    work_on_thread(run, work, stop);
  }).detach();

  std::unique_lock lock(run->mutex);
  const auto done = [&] { return run->done; };
  try {
    while (!run->ended.wait_for(lock, kPoll, done)) {
      lock.unlock();
      check_signals();
      lock.lock();
    }
  } catch (...) {
    stop.make();
    lock.lock();
    if (!run->ended.wait_for(lock, kPatience, done)) {
      cut_off_at_exit();
      run->is_abandoned = true;
      ++abandoned;
    }
    throw;
  }
  if (run->error) std::rethrow_exception(run->error);
}

void PartSize::adapt(double seconds) {
  constexpr double kShort = 0.05;  // seconds
  constexpr double kLong = 0.2;
  constexpr std::size_t kMax = std::size_t{1} << 18U;
  if (seconds < kShort) rays_ = std::min(2 * rays_, kMax);
  if (seconds > kLong) rays_ = std::max<std::size_t>(rays_ / 2, 1);
}

}  // namespace beambench::python
