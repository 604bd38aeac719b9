#pragma once
// Records what a process is doing where another process, the guard, can read it after a crash.

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace beambench::plugin {

/// A few lines of memory shared by two processes. Writing costs one copy of the text.
class Activity {
 public:
  enum class Line {
    kForeign,    ///< the current action of foreign code: "loading ./libmine.so"; empty: none
    kRunFolder,  ///< of the resumable sweep
    kCell        ///< the key of the cell being measured
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

  /// Records that a cell crashed: its key and a sentence. Returns false if the space is used up.
  bool add_crashed_cell(std::string_view key, std::string_view how);
  /// Returns the sentences by key.
  std::map<std::string, std::string> crashed_cells() const;

  /// Returns the descriptor for the process that writes here, which inherits it.
  int descriptor() const { return descriptor_; }

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

/// Runs this program again with the same arguments in a guarded process (see `guarded_activity`),
/// and returns the exit code for this one: that of the guarded process or, if foreign code crashed,
/// did not return from being loaded, or ended the process, 1 after a sentence on stderr with the
/// code and the place (2 if it was being loaded). If that happened in a cell of a sweep, the
/// program is run again, with the cell among the broken ones. Termination signals are passed on.
/// Called at the start of a program.
int run_guarded(char** arguments);

/// Returns where a guarded process records what it is doing; nullptr in other processes.
std::unique_ptr<Activity> guarded_activity();

}  // namespace beambench::plugin
