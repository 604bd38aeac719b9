#pragma once
// Records what a process is doing where another process, the guard, can read it after a crash.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace beambench::plugin {

/// A few lines of memory shared by two processes. Writing costs one copy of the text.
class Activity {
 public:
  enum class Line {
    kForeign,  ///< the current action of foreign code: "loading ./libmine.so"; empty: none
    kCell      ///< the cell of a block that is being measured
  };

  Activity();
  /// Opens that of another process, whose descriptor this one has inherited. Throws
  /// std::system_error if the descriptor refers to something else.
  explicit Activity(int descriptor);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Writes a text in two pieces, truncated if it is too long.
  void write(Line line, std::string_view text, std::string_view rest = "");
  void clear(Line line) { write(line, ""); }
  std::string read(Line line) const;
  /// Returns how many texts were written, by any process.
  std::uint64_t count() const;

  /// Returns the descriptor for the process that writes here, which inherits it.
  int descriptor() const { return descriptor_; }
  /// Returns the environment variable by which a process opens it: "BEAMBENCH_GUARD=3".
  std::string variable() const;

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

/// Runs this program again with the same arguments in a guarded process (see `guarded_activity`),
/// and returns the exit code for this one: that of the guarded process or, if foreign code crashed,
/// did not return from being loaded, or ended the process, 1 after a sentence on stderr with the
/// code and the place (2 if it was being loaded). Termination signals are passed on. Called at the
/// start of a program.
int run_guarded(char** arguments);

/// Returns how a process broke down, by its status (waitpid) and what it recorded: "the plug-in
/// ./libmine.so: tracing tetra with mine crashed (SIGSEGV: Segmentation fault)". Nothing if it
/// ended normally with exit code 0 outside of foreign code.
std::optional<std::string> describe_breakdown(int status, const Activity& activity);

/// Returns where a guarded process records what it is doing; nullptr in other processes.
std::unique_ptr<Activity> guarded_activity();

}  // namespace beambench::plugin
