#pragma once
// What a process is doing, recorded where another process can read it after a crash.

#include <map>
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
  bool add_broken_cell(std::string_view key, std::string_view how);
  /// By key.
  std::map<std::string, std::string> broken_cells() const;

  /// To be inherited by the process that writes here.
  int descriptor() const { return descriptor_; }

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

}  // namespace beambench::plugin
