#pragma once
// Runs long work on behalf of Python: without the GIL, and interruptible by Ctrl-C.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace beambench::python {

/// Throws nanobind::python_error if a Python signal handler raised an exception, such as that of
/// SIGINT (KeyboardInterrupt). Called without the GIL. Only Python's main thread handles signals;
/// on other threads this does nothing.
void check_signals();

/// Thrown when work ends because its caller was interrupted.
struct Stopped {};

/// A request to stop, made when the caller of some work was interrupted and no longer waits for it.
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

/// Does the work on a separate thread and waits for it. Called without the GIL. If the caller is
/// interrupted, the request is made and KeyboardInterrupt is thrown within about a second, whether
/// or not the work has ended. Therefore the work may only use objects that it owns (copies, shared
/// pointers), and nothing of Python's. Unfinished work is lost when the process ends.
void run_apart(std::function<void(const StopRequest&)> work);

/// Does the same with a result.
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

/// The size of the parts of a list, so that signals are noticed between two parts: the number of
/// rays traced in about a tenth of a second. Multiples of 16 (except for the slowest structures),
/// so that packets of rays are the same as without parts.
class PartSize {
 public:
  std::size_t rays() const { return rays_; }
  void adapt(double seconds);

 private:
  std::size_t rays_ = 16;
};

}  // namespace beambench::python
