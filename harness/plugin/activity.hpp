#pragma once
// What a process is doing, recorded where another process can read it after a crash; and the guard,
// which is that process.

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace beambench::plugin {

/// A few lines in memory that two processes share. Writing costs a copy of the text.
class Activity {
 public:
  enum class Line {
    kForeign,    ///< what foreign code is doing: "loading ./libmine.so"; empty: nothing
    kRunFolder,  ///< of the sweep that can be resumed
    kCell        ///< the key of the cell being measured
  };

  Activity();
  /// That of another process, whose descriptor this one has inherited. Throws std::system_error
  /// when the descriptor is of something else.
  explicit Activity(int descriptor);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Two pieces of one text, truncated where it is too long.
  void write(Line line, std::string_view text, std::string_view rest = "");
  void clear(Line line) { write(line, ""); }
  std::string read(Line line) const;

  /// Records that a cell crashed: its key and a sentence. False where there is no space left.
  bool add_crashed_cell(std::string_view key, std::string_view how);
  /// By key.
  std::map<std::string, std::string> crashed_cells() const;

  /// To be inherited by the process that writes here.
  int descriptor() const { return descriptor_; }

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

/// Runs this program once more with the same arguments, in a process of its own that finds by
/// `guarded_activity` that it is guarded, and returns what this one should end with: what that one
/// ended with, or where foreign code crashed, hung while it was loaded or ended the process, 1
/// after a sentence on stderr that says which and where (2 when it was being loaded). Where that
/// happened to a cell of a sweep, the program is run again, with the cell among the broken ones.
/// Signals to end are passed on. For the start of a program.
int run_guarded(char** arguments);

/// Where a guarded process records what it is doing; nullptr in others.
std::unique_ptr<Activity> guarded_activity();

}  // namespace beambench::plugin
