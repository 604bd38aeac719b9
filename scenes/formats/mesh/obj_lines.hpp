#pragma once
// Lines and words of OBJ files and their material libraries.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::scenes::mesh {

/// Removes and returns the next line of a text, without its end: "\n", "\r\n" or "\r".
std::string_view take_line(std::string_view& text);

/// Removes and returns the next word of a line. Empty at the end.
std::string_view take_word(std::string_view& line);

/// Returns the text without blanks at its ends.
std::string_view trimmed(std::string_view text);

/// Returns a name without the comment after it. Names may contain a '#', so only a '#' after a
/// blank begins a comment.
std::string_view without_comment(std::string_view name);

/// Counts the lines of a file that were not understood.
class UnknownLines {
 public:
  /// Records a line's number, from 1, and its first word.
  void add(std::size_t line, std::string_view word);
  bool empty() const { return count_ == 0; }
  /// Returns a message with the number of lines, and the line numbers and first words of the first
  /// few.
  std::string message() const;

 private:
  std::size_t count_ = 0;
  std::vector<std::string> first_;
};

}  // namespace beambench::scenes::mesh
