#pragma once
// Runs long work for Python: without the GIL, and interruptible by Ctrl-C.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace beambench::python {

/// Throws nanobind::python_error if a Python signal handler raised an exception, such as that of
/// SIGINT (KeyboardInterrupt). Call it without the GIL. Only Python's main thread handles signals;
/// on other threads this does nothing.
void check_signals();

/// Thrown when work ends because its caller was interrupted.
struct Stopped {};

/// A request to stop some work, made when its caller has been interrupted and no longer waits.
class StopRequest {
 public:
  bool made() const { return made_->load(std::memory_order_relaxed); }
  /// Throws Stopped if the request has been made.
  void check() const {
    if (made()) throw Stopped();
  }
  void make() const { made_->store(true, std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> made_ = std::make_shared<std::atomic<bool>>(false);
};

/// Does the work on a separate thread and waits for it. Call it without the GIL. If the caller is
/// interrupted, makes the request and throws KeyboardInterrupt within about a second, whether or
/// not the work has ended. Therefore the work may use only objects that it owns (copies, shared
/// pointers), and no Python objects. Unfinished work is lost when the process ends.
void run_apart(std::function<void(const StopRequest&)> work);

/// Runs work that returns a result in the same way, and returns the result.
template <class Work>
auto result_of(Work work) {
  using Result = std::invoke_result_t<Work&, const StopRequest&>;
  struct Shared {
    Work work;
    std::optional<Result> result{};
  };
  const auto shared = std::make_shared<Shared>(Shared{std::move(work)});
  run_apart([shared](const StopRequest& stop) { shared->result.emplace(shared->work(stop)); });
  return std::move(*shared->result);
}

/// The number of rays in each part of a list. A part takes about a tenth of a second, because
/// signals are handled only between two parts. The number is a multiple of 16 (except for the
/// slowest structures), so that packets of rays are the same as without parts.
class PartSize {
 public:
  std::size_t rays() const { return rays_; }
  void adapt(double seconds);

 private:
  std::size_t rays_ = 16;
};

}  // namespace beambench::python
