#pragma once
// Long work on behalf of Python: without the GIL, and ended by Ctrl-C.

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace beambench::python {

/// Throws nanobind::python_error where a signal handler of Python raised an exception, as that of
/// SIGINT does (KeyboardInterrupt). Called without the GIL. Only Python's main thread handles
/// signals; on others nothing happens.
void check_signals();

/// Work was ended because its caller was interrupted.
struct Stopped {};

/// Whether the caller of some work was interrupted and waits for it no longer.
class StopRequest {
 public:
  bool made() const { return made_->load(std::memory_order_relaxed); }
  /// Throws Stopped where it was made.
  void check() const {
    if (made()) throw Stopped();
  }
  void make() const { made_->store(true, std::memory_order_relaxed); }

 private:
  std::shared_ptr<std::atomic<bool>> made_ = std::make_shared<std::atomic<bool>>(false);
};

/// Does the work on a thread of its own and waits for it. Called without the GIL. When the caller
/// is interrupted, the request is made and KeyboardInterrupt thrown within about a second, whether
/// or not the work has ended: so it may only use what it owns (copies, shared pointers), and
/// nothing of Python's. Such work is cut off when the process ends.
void run_apart(std::function<void(const StopRequest&)> work);

/// The same with a result.
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

/// Into how many rays a list is cut, so that signals are noticed between two parts: as many as are
/// traced in about a tenth of a second. Multiples of 16 (but for the slowest structures), so that
/// packets of rays are the same as without cuts.
class PartSize {
 public:
  std::size_t rays() const { return rays_; }
  void adapt(double seconds);

 private:
  std::size_t rays_ = 16;
};

}  // namespace beambench::python
