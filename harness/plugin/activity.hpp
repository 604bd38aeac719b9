#pragma once
// Records the current action of a process, so that another process, the guard, can read it after a
// crash.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace beambench::plugin {

/// A few lines of memory shared by two processes. Writing costs one copy of the string.
class Activity {
 public:
  enum class Line {
    kForeign,  ///< the current action of foreign code: "loading ./libmine.so"; empty: none
    kCell      ///< the cell of a block that is being measured
  };

  Activity();
  /// Opens the memory of another process's Activity by a descriptor that this process has
  /// inherited. Throws std::system_error if the descriptor refers to something else.
  explicit Activity(int descriptor);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Writes a string given in two pieces, truncated if it is too long.
  void write(Line line, std::string_view text, std::string_view rest = "");
  void clear(Line line) { write(line, ""); }
  std::string read(Line line) const;
  /// Returns how many strings were written, by any process.
  std::uint64_t count() const;

  /// Returns the descriptor, which the writing process must inherit.
  int descriptor() const { return descriptor_; }
  /// Returns the environment variable from which a process reads the descriptor:
  /// "BEAMBENCH_GUARD=3".
  std::string variable() const;

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

/// Runs this program again with the same arguments in a guarded process (see `guarded_activity`),
/// and returns the exit code for this process. That is the guarded process's exit code, unless
/// foreign code crashed, ended the process, or did not finish loading. Then it is 1 (2 if the code
/// was being loaded), after a sentence on stderr that names the code and its action. Termination
/// signals are passed on. Called at the start of a program.
int run_guarded(char** arguments);

/// Returns how a process broke down, by its status (waitpid) and what it recorded: "the plug-in
/// ./libmine.so: tracing tetra with mine crashed (SIGSEGV: Segmentation fault)". Nothing if it
/// ended normally with exit code 0 outside of foreign code.
std::optional<std::string> describe_breakdown(int status, const Activity& activity);

/// Returns where a guarded process records what it is doing; nullptr in other processes.
std::unique_ptr<Activity> guarded_activity();

}  // namespace beambench::plugin
