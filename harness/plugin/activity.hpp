#pragma once
// What a process is at, told where another process can read it after a crash.

#include <map>
#include <string>
#include <string_view>

namespace beambench::plugin {

/// A few lines in memory that two processes share. Writing costs a copy of the text.
class Activity {
 public:
  enum class Line {
    kForeign,    ///< what foreign code is asked to do: "loading ./libmine.so"; empty: nothing
    kRunFolder,  ///< of the sweep that could go on
    kCell        ///< the key of the cell that is measured
  };

  Activity();
  /// The one behind the descriptor of another process, which this one has inherited. Throws
  /// std::system_error when it is none.
  explicit Activity(int descriptor);
  ~Activity();
  Activity(const Activity&) = delete;
  Activity& operator=(const Activity&) = delete;

  /// Two pieces of one text; what is too long is cut off.
  void write(Line line, std::string_view text, std::string_view rest = "");
  void clear(Line line) { write(line, ""); }
  std::string read(Line line) const;

  /// Notes that the work broke down over a cell: a key and a sentence. False where there is no room
  /// for more.
  bool add_broken_cell(std::string_view key, std::string_view how);
  /// By key.
  std::map<std::string, std::string> broken_cells() const;

  /// To be inherited by a process that is to write here.
  int descriptor() const { return descriptor_; }

 private:
  struct Board;
  int descriptor_;
  Board* board_;
};

}  // namespace beambench::plugin
